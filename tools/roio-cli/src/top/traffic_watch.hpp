/// TrafficWatch: takes what comes on a bus into a table of traffic, and tells how it stands.
#ifndef ROIO_CLI_TRAFFIC_WATCH_HPP
#define ROIO_CLI_TRAFFIC_WATCH_HPP

#include <chrono>
#include <cstdint>
#include <optional>
#include <roio/bus.hpp>
#include <string>
#include <vector>

#include "listen/hub_watch.hpp"
#include "program/bitrate.hpp"
#include "top/snapshot.hpp"

namespace roio::cli {

class TrafficWatch {
 public:
  /// @param bitrate_bps as the user says; none: as the bus does.
  /// @param labels live as long; they say what has a row of its own.
  TrafficWatch(Bus& bus, const std::string& url, std::optional<std::uint32_t> bitrate_bps,
               const Labels& labels);

  /// Takes what has come, without waiting.
  enum class Taken : std::uint8_t {
    nothing,
    some,  ///< More will gather, and may as well be waited for.
    many,  ///< More has come meanwhile.
    closed,
  };
  Taken take();

  /// An interval ends.
  Snapshot snapshot();
  void clear();

 private:
  void look_at_hub();
  [[nodiscard]] Statistics statistics() const;

  Bus& bus_;
  bool is_local_;
  BitrateSource bitrate_;
  HubWatch hub_watch_;
  HubWatch::Clock::time_point next_look_;  // at once
  TrafficTable table_;
  std::vector<Received> batch_;
  Statistics cleared_;  // what had been counted then
};

}  // namespace roio::cli

#endif
