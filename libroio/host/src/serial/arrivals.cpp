#include "serial/arrivals.hpp"

#include <roio/serial_protocol.hpp>

namespace roio::serial {

void Arrivals::begin() {
  up_.begin();
  repeated_.begin();
  clock_.begin();
  impossible_ = 0;
}

bool Arrivals::take(const Frame& frame, std::span<const std::uint8_t> body, Time now) {
  if (repeated_.take(body)) {
    return false;
  }
  up_.take(body[sequence_at]);
  const std::uint64_t lost_before = up_.lost() - std::exchange(lost_told_, up_.lost());
  arrived_.push_back({frame, clock_.frame(get16(&body[time_at]), now), lost_before});
  return true;
}

Arrivals::Told Arrivals::status(std::uint32_t ticks, std::uint32_t due, Time now) {
  if (clock_.status(ticks, now) && up_.settle(due)) {
    impossible_ = 0;
    return Told::sense;
  }
  ++impossible_;
  return impossible_ < max_impossible ? Told::nonsense : Told::other_board;
}

}  // namespace roio::serial
