#ifndef ROIO_SERIAL_SET_UP_HPP
#define ROIO_SERIAL_SET_UP_HPP

#include <cstdint>
#include <optional>

#include "serial/known_bridge.hpp"
#include "serial/requests.hpp"
#include "serial/settings.hpp"

namespace roio::serial {

/// What a bridge is still to be told before frames go down: first the line rate is settled, then
/// come the requests for the settings, as far as it has others.
class SetUp {
 public:
  /// From the start.
  void begin() { step_ = Step::line_rate; }
  /// Whether the line rate's turn is now; asked once.
  bool takes_line_rate();
  /// The next request, which is to be answered before the one after it. None: all is said.
  /// @param bridge outlives the request, and is told what it has taken.
  std::optional<Request> next(const SerialSettings& settings, KnownBridge& bridge);

 private:
  enum class Step : std::uint8_t { line_rate, bus, address, rules, done };

  Step step_ = Step::line_rate;
};

/// A request for this bus, which tells `bridge` when it was taken, and then `done`.
Request bus_request(KnownBridge& bridge, std::uint32_t bitrate_bps, BridgeMode mode, Done done);

}  // namespace roio::serial

#endif
