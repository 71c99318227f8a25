#ifndef ROIO_SERIAL_SETTINGS_HPP
#define ROIO_SERIAL_SETTINGS_HPP

#include <chrono>
#include <cstdint>
#include <optional>
#include <roio/address.hpp>
#include <roio/bridge.hpp>
#include <roio/bus.hpp>
#include <roio/text.hpp>
#include <vector>

#include "serial/payloads.hpp"

namespace roio {

/// What a session is to make of its bridge, and of the frames for it.
struct SerialSettings {
  std::chrono::nanoseconds lifetime = std::chrono::seconds(1);  ///< As OpenOptions has it.
  std::uint32_t line_rate_bps = 1'000'000;                      ///< The highest to be used.
  std::optional<std::uint32_t> bitrate_bps{};                   ///< None: as the bridge has it.
  std::optional<BridgeMode> mode{};                             ///< None: as the bridge has it.
  std::optional<Address> address{};                             ///< None: as the bridge has it.
  /// At most serial::max_rules, of which one must match; none: as the bridge has them.
  std::optional<std::vector<serial::Rule>> rules{};
  bool in_order = false;  ///< OpenOptions::in_order.
};

SerialSettings settings_of(const BusUrl& url, const OpenOptions& options,
                           std::vector<serial::Rule> rules);

}  // namespace roio

#endif
