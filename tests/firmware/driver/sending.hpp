// What tests of sending share.
#ifndef ROIO_TESTS_DRIVER_SENDING_HPP
#define ROIO_TESTS_DRIVER_SENDING_HPP

#include <algorithm>
#include <vector>

#include "rig.hpp"

namespace roio::test {

inline constexpr std::uint8_t queue = 32;
using SendingRig = Rig<false, 0, queue>;

inline std::vector<std::uint32_t> numbers_of(const std::vector<Frame>& frames) {
  std::vector<std::uint32_t> numbers;
  std::transform(frames.begin(), frames.end(), std::back_inserter(numbers), number_of);
  return numbers;
}

inline std::vector<std::uint32_t> counting(std::uint32_t first, std::uint32_t count) {
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t i = 0; i < count; ++i) {
    numbers.push_back(first + i);
  }
  return numbers;
}

/// Polls as a program would until all is gone.
template <typename AnyRig>
void poll_until_idle(AnyRig& rig, sim::SimTime limit = std::chrono::seconds(1)) {
  const sim::SimTime end = rig.bus.now() + limit;
  while (rig.can.waiting() + rig.can.in_flight() > 0 && rig.bus.now() < end) {
    ASSERT_EQ(rig.can.poll(), Status::ok);
    rig.bus.run_for(microseconds(20));
  }
  EXPECT_EQ(rig.can.waiting() + rig.can.in_flight(), 0);
}

}  // namespace roio::test

#endif
