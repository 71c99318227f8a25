#include "serial/clock.hpp"

#include <algorithm>
#include <roio/serial_protocol.hpp>

namespace roio::serial {
namespace {

constexpr Time tick = std::chrono::microseconds(ticks_us);
constexpr int drift_divisor = 100;

}  // namespace

bool BridgeClock::status(std::uint32_t ticks, Time arrival) {
  if (!known_) {
    known_ = true;
    ticks_ = ticks;
    offset_ = arrival - tick * ticks_;
    corrected_at_ = arrival;
    return true;
  }
  const auto ahead = static_cast<std::int32_t>(ticks - static_cast<std::uint32_t>(ticks_));
  if (ahead < 0) {
    return false;
  }
  ticks_ += ahead;
  correct(arrival);
  return true;
}

Time BridgeClock::frame(std::uint16_t ticks, Time arrival) {
  Time time = arrival;
  if (known_) {
    ticks_ += static_cast<std::uint16_t>(ticks - static_cast<std::uint16_t>(ticks_));
    correct(arrival);
    time = tick * ticks_ + offset_;
  }
  last_ = std::max(last_, time);
  return last_;
}

void BridgeClock::correct(Time arrival) {
  const Time grown = offset_ + (arrival - corrected_at_) / drift_divisor;
  offset_ = std::min(grown, arrival - tick * ticks_);
  corrected_at_ = arrival;
}

}  // namespace roio::serial
