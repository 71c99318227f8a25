/// What every test of the bus contract needs: buses of one backend, frames that can be told apart,
/// and receiving with a hang guard.
#ifndef ROIO_TESTS_CONTRACT_CONTRACT_HPP
#define ROIO_TESTS_CONTRACT_CONTRACT_HPP

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <cstring>
#include <future>
#include <initializer_list>
#include <memory>
#include <ostream>
#include <roio/bus.hpp>
#include <string>
#include <utility>
#include <vector>

#include "backends.hpp"

namespace roio {

/// Frames are equal when a receiver could not tell them apart: remote frames carry no data, and
/// nothing past the length counts.
bool operator==(const Frame& a, const Frame& b);
std::ostream& operator<<(std::ostream& out, const Frame& frame);

}  // namespace roio

namespace roio::test {

/// No test waits longer than this for what should come; it only ends tests that would hang.
inline constexpr std::chrono::seconds guard{60};
/// How long to listen for what should not come. Too short can only hide a fault, never make one up.
inline constexpr std::chrono::milliseconds moment{30};

/// An extended frame of normal priority that carries a number.
Frame numbered(std::uint32_t number, std::uint32_t id = 0x1000400A);
std::uint32_t number_of(const Frame& frame);

/// Receives exactly this many, or fails the test.
std::vector<Received> receive_exactly(Bus& bus, std::size_t count);
std::vector<Frame> frames_of(const std::vector<Received>& received);
void expect_silence(Bus& bus);
void send_all(Bus& bus, const std::vector<Frame>& frames);
/// Whether poll() finds the bus readable, at once or within the time.
bool is_readable(const Bus& bus, std::chrono::milliseconds timeout = std::chrono::milliseconds(0));

/// Runs in another thread; get() of the result would wait for ever where the guard does not.
template <typename Call>
auto in_thread(Call call) {
  return std::async(std::launch::async, std::move(call));
}
template <typename T>
T result_of(std::future<T>& future) {
  if (future.wait_for(guard) != std::future_status::ready) {
    ADD_FAILURE() << "a call that should have returned still waits";
    std::abort();  // the future's destructor would wait for ever
  }
  return future.get();
}

class Contract : public testing::TestWithParam<Backend> {
 protected:
  Contract() : venue_(GetParam().fresh()) {}

  /// One more participant of this test's bus.
  [[nodiscard]] std::unique_ptr<Bus> join(const OpenOptions& options = {}) const {
    return venue_.join(options);
  }
  [[nodiscard]] const std::string& url() const { return venue_.url; }

 private:
  Venue venue_;
};

inline std::string backend_name(const testing::TestParamInfo<Backend>& info) {
  return info.param.name;
}

}  // namespace roio::test

/// Declares a part of the suite and runs it against every backend, or against those that have a
/// trait.
// NOLINTBEGIN(bugprone-macro-parentheses): names of classes and members
#define ROIO_CONTRACT(Part)                                                      \
  class Part : public roio::test::Contract {};                                   \
  INSTANTIATE_TEST_SUITE_P(Bus, Part, testing::ValuesIn(roio::test::backends()), \
                           roio::test::backend_name)
#define ROIO_CONTRACT_WHERE(Part, trait)                                                     \
  class Part : public roio::test::Contract {};                                               \
  GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Part);                                       \
  INSTANTIATE_TEST_SUITE_P(                                                                  \
      Bus, Part, testing::ValuesIn(roio::test::backends_where(&roio::test::Backend::trait)), \
      roio::test::backend_name)
// NOLINTEND(bugprone-macro-parentheses)

#endif
