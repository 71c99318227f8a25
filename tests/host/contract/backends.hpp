/// The buses that the contract suite runs against: whoever runs it says which
/// (docs/backend.md). Here it is backends.cpp, where a further backend is a further row.
#ifndef ROIO_TESTS_CONTRACT_BACKENDS_HPP
#define ROIO_TESTS_CONTRACT_BACKENDS_HPP

#include <cstddef>
#include <functional>
#include <memory>
#include <ostream>
#include <roio/bus.hpp>
#include <string>
#include <vector>

namespace roio::test {

/// One bus. Participants come by join(), and are gone before it is.
struct Venue {
  std::string url;  ///< Bus::name() of all participants, and options after a '?'.
  std::function<std::unique_ptr<Bus>(const OpenOptions&)> join;
};

struct Backend {
  std::string name;
  /// A bus that nobody else uses; the same bus each time only where there is but one.
  std::function<Venue()> fresh;
  bool arbitrates;  ///< Urgent frames pass normal ones that still wait.
  bool paced;       ///< Frames take their time, so that a queue fills and send() waits.
  bool one_order;   ///< All receivers see one and the same order.
  /// A sender's controller has the next frame before the pause after the last one is over, but for
  /// every other frame at most.
  bool refills_fast;
  bool there_at_once;     ///< A bus that is there is opened with OpenOptions::open_timeout zero.
  std::size_t flood = 0;  ///< Frames that a receiver which does not read may well be too many for.
};

inline std::ostream& operator<<(std::ostream& out, const Backend& backend) {
  return out << backend.name;
}

/// To be defined by the program that the suite is linked into; called when it starts.
/// Here: the local bus, the simulated chips and the example always; the bridge where its image is
/// built; SocketCAN on the interface that the environment variable ROIO_TEST_CAN names, when it is
/// set (that one bus is then every test's: run them one at a time).
std::vector<Backend> backends();
/// Those of them that have a trait.
std::vector<Backend> backends_where(bool Backend::*trait);

}  // namespace roio::test

#endif
