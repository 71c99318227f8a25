#ifndef ROIO_SERIAL_KNOWN_BRIDGE_HPP
#define ROIO_SERIAL_KNOWN_BRIDGE_HPP

#include <cstdint>
#include <optional>
#include <roio/bridge.hpp>
#include <roio/serial_protocol.hpp>
#include <utility>

#include "serial/reports.hpp"

namespace roio::serial {

/// What a session knows of its bridge: what WELCOME said, what it was told since, and its STATUS.
class KnownBridge {
 public:
  /// The WELCOME that opens a session.
  void begin(const Welcome& welcome) {
    info_ = welcome.info;
    previous_session_ = welcome.previous_session;
    questions_ = 0;
  }
  /// A further one: whether it is of the same bridge, which has what it was told.
  /// @param is_settled nothing is being changed just now, so that it can be compared.
  [[nodiscard]] bool is_still(const Welcome& welcome, bool is_settled) const {
    const bool is_set_up =
        welcome.info.bitrate_bps == info_.bitrate_bps && welcome.info.mode == info_.mode;
    return welcome.previous_session == previous_session_ && (is_set_up || !is_settled);
  }
  /// What only a controller can tell, which may not have been there for the first WELCOME.
  void learn(const Welcome& welcome) {
    info_.osc_khz = welcome.info.osc_khz;
    info_.interrupt_wired = welcome.info.interrupt_wired;
  }
  /// @return whether the state has changed.
  bool take(const BridgeStatus& status) {
    info_.transmit_errors = status.transmit_errors;
    info_.receive_errors = status.receive_errors;
    return std::exchange(info_.state, status.state) != status.state;
  }

  void set_bus(std::uint32_t bitrate_bps, BridgeMode mode) {
    info_.bitrate_bps = bitrate_bps;
    info_.mode = mode;
  }
  void set_address(Address address) {
    info_.address = is_broadcast(address) ? std::nullopt : std::optional(address);
  }

  [[nodiscard]] bool controller_works() const {
    return info_.state != BridgeState::no_controller && info_.state != BridgeState::stuck;
  }
  /// Whether there is a controller whose crystal nobody knows, and it is worth asking.
  [[nodiscard]] bool has_unknown_crystal() const {
    return info_.osc_khz == 0 && controller_works() && questions_ < max_questions;
  }
  void note_question() { ++questions_; }

  /// port is empty, line_rate_bps not the present one.
  [[nodiscard]] const BridgeInfo& info() const { return info_; }

 private:
  static constexpr unsigned max_questions = 4;

  BridgeInfo info_;
  std::uint32_t previous_session_ = no_session;  // before this one, as WELCOME had it
  unsigned questions_ = 0;                       // for the crystal
};

}  // namespace roio::serial

#endif
