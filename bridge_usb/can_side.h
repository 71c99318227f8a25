/// CanSide: the bridge's MCP2515: finds its crystal and its INT line out, keeps it running, and
/// takes back frames whose time is over.
///
/// The chip lets everything through, and the filter is looked at here: to change the chip's own, it
/// has to leave the bus for a millisecond, and what comes then is lost without a trace.
#ifndef ROIO_BRIDGE_CAN_SIDE_H
#define ROIO_BRIDGE_CAN_SIDE_H

#include "clock.h"
#include "config.h"
#include "slots.h"

namespace roio {
namespace bridge {

/// The Arduino port, but for a clock that is at hand, and an INT line that may not be there: then
/// it counts as low, and the driver looks at the chip each time.
class Port : public ArduinoPort<FixedPin<ROIO_BRIDGE_CS_PIN>, FixedPin<ROIO_BRIDGE_INT_PIN>> {
  using Line = FixedPin<ROIO_BRIDGE_INT_PIN>;

 public:
  explicit Port(Clock& clock) : clock_(clock), is_wired_(false) {}

  bool interrupt_line_is_low() { return !is_wired_ || Line::is_low(); }
  uint32_t microseconds() { return clock_.ticks() * serial::ticks_us; }

  bool is_wired() const { return is_wired_; }
  /// Has the chip pull the line by a flag that nothing else sets, and looks at it.
  void find_interrupt_line() {
    set_wake_up_flag(true);
    const bool goes_low = Line::is_low();
    set_wake_up_flag(false);
    is_wired_ = goes_low && !Line::is_low();
  }

 private:
  /// WAKIE and WAKIF.
  void set_wake_up_flag(bool on) {
    constexpr uint8_t wake_up = 0x40;
    constexpr mcp2515::Register registers[] = {mcp2515::Register::caninte,
                                               mcp2515::Register::canintf};
    for (const mcp2515::Register address : registers) {
      Transaction transaction(*this, static_cast<uint8_t>(mcp2515::Instruction::bit_modify));
      transaction.put(static_cast<uint8_t>(address));
      transaction.put(wake_up);
      transaction.put(on ? wake_up : 0);
    }
  }

  Clock& clock_;
  bool is_wired_;
};

class CanSide {
  struct Traits : Mcp2515Traits {
    using Count = uint32_t;
    static constexpr bool all_kinds = true;
    static constexpr bool back_to_back = true;
    static constexpr bool reports_outcomes = true;
    static constexpr bool doubts_line = false;  // the Port finds out; and each cycle counts
    void on_outcome(uint8_t token, TxOutcome outcome) {
      slots.end(token, outcome == TxOutcome::sent      ? serial::Outcome::sent
                       : outcome == TxOutcome::unknown ? serial::Outcome::unknown
                                                       : serial::Outcome::not_sent);
    }
    bool is_over(uint8_t token) const { return slots.is_over(token); }
    Slots slots;
  };
  /// All of a window may be urgent, and the chip has one of those.
  using Driver = Mcp2515<Port, 0, serial::window - 1, Traits>;

 public:
  explicit CanSide(Clock& clock)
      : driver_(clock),
        clock_(clock),
        osc_hz_(0),
        bitrate_bps_(default_bitrate_bps),
        sample_point_permille_(default_sample_point_permille(default_bitrate_bps)),
        mode_(serial::Mode::normal),
        start_status_(Status::no_chip),
        tried_at_(0),
        looked_at_(0),
        is_stopped_(false),
        is_fast_(false) {}

  void begin() {
    driver_.port().begin();
    start();
  }

  /// Whether the crystal, as far as it is known, can make this bit rate.
  bool can_make(uint32_t bitrate_bps) const {
    return osc_hz_ == 0 || is_valid(timing_of(osc_hz_, bitrate_bps, 0));
  }
  /// Starts the controller anew with these. What was to be sent is not sent, but for what the chip
  /// had already: that is unknown from then on.
  /// @return as Mcp2515::begin(); with bad_argument and bad_timing nothing has changed.
  Status configure(uint32_t bitrate_bps, uint16_t sample_point_permille, serial::Mode mode) {
    if (static_cast<uint8_t>(mode) > static_cast<uint8_t>(serial::Mode::loopback)) {
      return Status::bad_argument;
    }
    if (!can_make(bitrate_bps)) {
      return Status::bad_timing;
    }
    slots().set_all_over(true);
    driver_.abort();
    bitrate_bps_ = bitrate_bps;
    sample_point_permille_ = sample_point_permille;
    is_fast_ = bitrate_bps > 500000;
    mode_ = mode;
    const Status status = start();
    slots().set_all_over(false);
    return status;
  }
  Status configure(uint32_t bitrate_bps, serial::Mode mode) {
    return configure(bitrate_bps, default_sample_point_permille(bitrate_bps), mode);
  }
  /// Whose frames were to be sent is gone: they are taken back, and nobody asks for their outcomes.
  void begin_session() {
    slots().begin_session();
    driver_.abort();
  }
  /// Off the bus, until configure().
  void stop() {
    begin_session();
    driver_.stop();
    is_stopped_ = true;
  }

  /// To be called every millisecond. Takes back frames that have waited for as long as they may,
  /// and takes up again a controller that was lost, or not there: a try takes up to 180 ms.
  void tend() {
    if (slots().pass_time(clock_.coarse())) {
      driver_.abort();
    }
    constexpr uint16_t retry = Clock::coarse_of_ms(250);
    if (!driver_.running() && !is_stopped_ &&
        static_cast<uint16_t>(clock_.coarse() - tried_at_) >= retry) {
      start();
    }
  }

  /// As Mcp2515::receive(). While the INT line says that nothing has come, the chip is asked only
  /// now and then, for what became of frames: that takes ten times as long as not to ask.
  Status receive(Mcp2515Frame& frame) {
    constexpr uint8_t interval = 48 / serial::ticks_us;
    const uint8_t now = static_cast<uint8_t>(Clock::low_ticks());
    if (!driver_.port().interrupt_line_is_low() &&
        static_cast<uint8_t>(now - looked_at_) < interval) {
      return Status::empty;
    }
    looked_at_ = now;
    return driver_.receive(frame);
  }
  /// Whether the INT line says that a frame waits.
  bool has_received() {
    return driver_.port().is_wired() && driver_.port().interrupt_line_is_low();
  }
  /// Whether frames may always come faster than they are handed on.
  bool is_fast() const { return is_fast_; }
  /// Whether the INT line says that none does.
  bool is_quiet() { return driver_.port().is_wired() && !driver_.port().interrupt_line_is_low(); }
  /// @param token comes back to slots() with the frame's outcome.
  Status send(const Frame& frame, uint8_t token) { return driver_.send(frame, token); }
  /// A frame of the bridge's own.
  Status send_own(const Frame& frame) {
    slots().begin_own();
    return driver_.send(frame, Slots::no_token);
  }
  Status send(const Mcp2515Frame& frame, uint8_t token) { return driver_.send(frame, token); }

  bool is_stopped() const { return is_stopped_; }
  serial::State state() const {
    return driver_.running()                     ? static_cast<serial::State>(driver_.state())
           : start_status_ == Status::wrong_mode ? serial::State::stuck
                                                 : serial::State::no_chip;
  }
  void read_error_counters(uint8_t& transmit, uint8_t& receive) {
    transmit = receive = 0;
    if (driver_.running()) {
      driver_.read_error_counters(transmit, receive);
    }
  }
  Driver::Counters counters() const { return driver_.counters(); }
  Slots& slots() { return driver_.traits().slots; }
  /// 0: no controller answers.
  uint32_t osc_hz() const { return osc_hz_; }
  bool interrupt_is_wired() { return driver_.port().is_wired(); }
  uint32_t bitrate_bps() const { return bitrate_bps_; }
  serial::Mode mode() const { return mode_; }

 private:
  Mcp2515Config config_of(uint32_t osc_hz, uint32_t bitrate_bps, mcp2515::Mode mode) const {
    return Mcp2515Config(timing_of(osc_hz, bitrate_bps, sample_point_permille_),
                         mcp2515_filters_of_everything(), mode);
  }
  /// One copy of the search: it is long.
  __attribute__((noinline)) static BitTiming timing_of(uint32_t osc_hz, uint32_t bitrate_bps,
                                                       uint16_t sample_point_permille) {
    return compute_bit_timing(osc_hz, bitrate_bps, sample_point_permille);
  }

  Status start() {
    is_stopped_ = false;
    start_status_ = osc_hz_ == 0 ? find_crystal() : Status::ok;
    if (start_status_ == Status::ok) {
      start_status_ = driver_.begin(config_of(osc_hz_, bitrate_bps_, driver_mode()));
    }
    clock_.update();  // that may have taken a while
    tried_at_ = clock_.coarse();
    return start_status_;
  }

  mcp2515::Mode driver_mode() const {
    return mode_ == serial::Mode::normal        ? mcp2515::Mode::normal
           : mode_ == serial::Mode::listen_only ? mcp2515::Mode::listen_only
                                                : mcp2515::Mode::loopback;
  }

  /// Measures it against the processor's own, and takes the nearest that modules are sold with.
  Status find_crystal() {
    constexpr uint32_t guess_hz = 16000000;
    uint32_t measured_hz = 0;
    const Status status = driver_.check_clock(
        config_of(guess_hz, default_bitrate_bps, mcp2515::Mode::loopback), guess_hz, measured_hz);
    if (measured_hz == 0) {
      return status == Status::ok ? Status::no_chip : status;
    }
    static constexpr uint8_t crystals_mhz[] = {8, 10, 12, 16, 20, 24};
    for (const uint8_t mhz : crystals_mhz) {
      const uint32_t hz = mhz * UINT32_C(1000000);
      const uint32_t off = measured_hz > hz ? measured_hz - hz : hz - measured_hz;
      if (off < hz / 16U) {
        osc_hz_ = hz;
        driver_.port().find_interrupt_line();
        return Status::ok;
      }
    }
    return Status::wrong_clock;
  }

  Driver driver_;
  Clock& clock_;
  uint32_t osc_hz_;
  uint32_t bitrate_bps_;
  uint16_t sample_point_permille_;
  serial::Mode mode_;
  Status start_status_;
  uint16_t tried_at_;
  uint8_t looked_at_;
  bool is_stopped_;
  bool is_fast_;
};

}  // namespace bridge
}  // namespace roio

#endif
