/// HubWatch: whether a local bus is gone, and how often it was. Pure: what it is and the time go
/// in. Another process becomes the hub within moments, and nothing is lost by it: that is no
/// outage.
#ifndef ROIO_CLI_HUB_WATCH_HPP
#define ROIO_CLI_HUB_WATCH_HPP

#include <chrono>
#include <cstdint>
#include <optional>
#include <roio/bus.hpp>

namespace roio::cli {

class HubWatch {
 public:
  using Clock = std::chrono::steady_clock;

  /// A local bus without a hub for so long is an outage.
  static constexpr std::chrono::seconds hub_change_time{2};

  void look(BusState state, Clock::time_point now);
  [[nodiscard]] std::uint64_t outages() const { return outages_; }
  /// It is absent, and not for long enough to be out.
  [[nodiscard]] bool is_between_hubs() const { return absent_since_ && !is_counted_; }

 private:
  std::optional<Clock::time_point> absent_since_;
  bool is_counted_ = false;  // the absence that lasts
  std::uint64_t outages_ = 0;
};

}  // namespace roio::cli

#endif
