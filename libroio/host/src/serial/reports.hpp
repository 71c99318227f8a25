/// What a bridge says of itself, read: WELCOME, STATUS and COUNTERS.
/// Source: docs/internals/serial-protocol.md "Up".
#ifndef ROIO_SERIAL_REPORTS_HPP
#define ROIO_SERIAL_REPORTS_HPP

#include <cstddef>
#include <cstdint>
#include <optional>
#include <roio/bridge.hpp>
#include <roio/serial_protocol.hpp>
#include <span>

namespace roio::serial {

/// WELCOME of this protocol version.
struct Welcome {
  std::uint32_t session;
  std::uint32_t previous_session;
  std::uint32_t previous_due;  ///< Frames due in that one.
  BridgeInfo info;             ///< state: absent, until STATUS tells.
  std::uint8_t rates;          ///< Bit i: rate_bps(i).
};
/// @param payload behind the control head. @return none: it makes no sense.
std::optional<Welcome> read_welcome(std::span<const std::uint8_t> payload);
/// What its crystal makes of its bit rate: the bridge computes its timing alike. 0: no crystal.
std::uint32_t real_bitrate_bps(const BridgeInfo& info);
/// Of a WELCOME of another version, if it says so where version 1 does.
std::optional<FirmwareVersion> firmware_of(std::span<const std::uint8_t> payload);

struct BridgeStatus {
  std::uint32_t ticks;  ///< The bridge's clock.
  std::uint32_t due;    ///< Frames due in this session.
  BridgeState state;
  std::uint8_t transmit_errors;
  std::uint8_t receive_errors;
};
/// @param payload behind the control head. @return none: it makes no sense.
std::optional<BridgeStatus> read_status(std::span<const std::uint8_t> payload);

/// COUNTERS, which come in several records.
class CounterReports {
 public:
  enum class Event : std::uint8_t {
    nonsense,
    part,      ///< More are to come; or some were lost, and the next report is the one to wait for.
    complete,  ///< counters() are new.
  };
  /// @param payload behind the control head.
  Event take(std::span<const std::uint8_t> payload);

  [[nodiscard]] const BridgeCounters& counters() const { return counters_; }
  /// How many were complete.
  [[nodiscard]] std::uint64_t count() const { return count_; }

 private:
  BridgeCounters counters_;
  BridgeCounters next_;     // of the report that is coming in
  std::size_t so_far_ = 0;  // of it
  std::uint64_t count_ = 0;
};

}  // namespace roio::serial

#endif
