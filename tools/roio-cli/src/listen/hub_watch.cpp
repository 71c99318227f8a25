#include "listen/hub_watch.hpp"

namespace roio::cli {

void HubWatch::look(BusState state, Clock::time_point now) {
  const bool is_absent = state == BusState::absent;
  if (is_absent && !absent_since_) {
    absent_since_ = now;
    is_counted_ = false;
  }
  if (absent_since_ && !is_counted_ && now - *absent_since_ >= hub_change_time) {
    is_counted_ = true;
    ++outages_;
  }
  if (!is_absent) {
    absent_since_.reset();
  }
}

}  // namespace roio::cli
