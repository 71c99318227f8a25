/// CanSide: the bridge's MCP2515: finds its crystal and its INT line out, keeps it running, and
/// keeps the outcomes of frames.
///
/// The chip lets everything through, and the filter is looked at here: to change the chip's own, it
/// has to leave the bus for a millisecond, and what comes then is lost without a trace.
#ifndef ROIO_BRIDGE_CAN_SIDE_H
#define ROIO_BRIDGE_CAN_SIDE_H

#include "clock.h"
#include "config.h"

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
      Transaction transaction(*this);
      transaction.exchange(static_cast<uint8_t>(mcp2515::Instruction::bit_modify));
      transaction.exchange(static_cast<uint8_t>(address));
      transaction.exchange(wake_up);
      transaction.exchange(on ? wake_up : 0);
    }
  }

  Clock& clock_;
  bool is_wired_;
};

/// What became of the last 16 frames from the PC, two bits each, as RESULTS has it, and until when
/// each may wait. The driver's token of a frame is its slot, and which session's it is: those of a
/// former one are over, though they may still come to an end.
class Slots {
 public:
  static constexpr uint8_t no_token = 0xFF;      ///< Of a frame that has no slot: the bridge's own.
  static constexpr uint8_t default_life = 0x6F;  ///< 0.98 s: of such, and of SLCAN's.

  Slots()
      : bytes_(),
        until_(),
        soonest_(no_end),
        now_(0),
        generation_(0),
        pending_(0),
        news_(0),
        all_over_(false) {}

  void begin_session() {
    for (uint8_t& byte : bytes_) {
      byte = 0;
    }
    for (uint8_t slot = 0; slot < serial::window; ++slot) {
      until_[slot] = no_end;
    }
    generation_ = static_cast<uint8_t>((generation_ + 1U) % generations);
    pending_ = 0;
    news_ = 0;
  }
  uint8_t token_of(uint8_t sequence) const {
    return static_cast<uint8_t>((generation_ << 4) | (sequence & 0x0FU));
  }
  /// @param life as a frame's record has it.
  void begin(uint8_t token, uint8_t life) {
    put(token, serial::Outcome::pending);
    set_end(token & 0x0FU, life);
    ++pending_;
  }
  /// A frame of the bridge's own: with the last of them, all are over.
  void begin_own() { set_end(own, default_life); }
  void end(uint8_t token, serial::Outcome outcome) {
    if ((token >> 4) != generation_) {
      return;
    }
    put(token, outcome);
    until_[token & 0x0FU] = no_end;
    --pending_;
    add_news();
  }
  /// Of a frame that has an end: whether it still waits.
  bool is_pending(uint8_t token) const { return until_[token & 0x0FU] != no_end; }

  /// @param now Clock::coarse().
  /// @return whether frames are over that the driver may have.
  bool pass_time(uint16_t now) {
    now_ = now;
    return soonest_ != no_end && is_past(soonest_) && look_for_expired();
  }
  /// All that wait are over, or as they were.
  void set_all_over(bool over) { all_over_ = over; }
  bool is_over(uint8_t token) const {
    if (token == no_token) {
      return all_over_ || until_[own] == no_end || is_past(until_[own]);
    }
    const uint16_t until = until_[token & 0x0FU];
    return all_over_ || (token >> 4) != generation_ || (until != no_end && is_past(until));
  }

  /// What the PC does not know yet: a frame was taken, or came to its end.
  void add_news() { ++news_; }
  void take_news() { news_ = 0; }
  bool has_news() const { return news_ != 0; }
  /// Several are told at once, the more so while the bus is busy with others' frames; a frame that
  /// is alone is told at once.
  bool is_news_due(bool is_busy) const {
    return news_ != 0 && (news_ >= (is_busy ? busy_news : enough_news) || pending_ == 0);
  }
  /// Slots 4n+3..4n.
  uint8_t byte(uint8_t n) const { return bytes_[n]; }

 private:
  static constexpr uint8_t enough_news = 6;
  static constexpr uint8_t busy_news = 12;
  static constexpr uint8_t generations = 15;  // with a 16th, no_token would be a token
  static constexpr uint8_t own = serial::window;
  static constexpr uint16_t no_end = 0;  // of a frame that may wait for ever; or there is none
  static constexpr uint8_t again_after = 8;

  static constexpr uint16_t not_no_end(uint16_t time) {
    return time == no_end ? static_cast<uint16_t>(no_end - 1U) : time;
  }
  bool is_past(uint16_t time) const { return static_cast<uint16_t>(now_ - time) < 0x8000U; }
  void note_end(uint16_t until) {
    if (soonest_ == no_end || static_cast<uint16_t>(until - soonest_) >= 0x8000U) {
      soonest_ = until;
    }
  }
  void set_end(uint8_t place, uint8_t life) {
    uint16_t until = no_end;
    if (life != serial::life_forever) {
      life = life < serial::longest_life ? life : serial::longest_life;
      until = not_no_end(static_cast<uint16_t>(now_ + serial::life_units(life)));
      note_end(until);
    }
    until_[place] = until;
  }
  bool look_for_expired() {
    bool any = false;
    soonest_ = no_end;
    for (uint16_t until : until_) {
      if (until != no_end && is_past(until)) {
        any = true;
        until = not_no_end(static_cast<uint16_t>(now_ + again_after));  // unless it ends before
      }
      if (until != no_end) {
        note_end(until);
      }
    }
    if (is_past(until_[own])) {
      until_[own] = no_end;
    }
    return any;
  }

  void put(uint8_t token, serial::Outcome outcome) {
    static const uint8_t ones[4] = {0x01, 0x04, 0x10, 0x40};  // an AVR shifts bit by bit
    uint8_t& byte = bytes_[(token >> 2) & 3U];
    const uint8_t one = ones[token & 3U];
    byte = static_cast<uint8_t>((byte & ~(one * 3U)) | (one * static_cast<uint8_t>(outcome)));
  }

  uint8_t bytes_[4];
  uint16_t until_[serial::window + 1];  // Clock::coarse(): of each slot, and of the bridge's own
  uint16_t soonest_;                    // of those, or before it
  uint16_t now_;
  uint8_t generation_;
  uint8_t pending_;
  uint8_t news_;
  bool all_over_;
};

class CanSide {
  struct Traits : Mcp2515Traits {
    using Count = uint32_t;
    static constexpr bool all_kinds = true;
    static constexpr bool back_to_back = true;
    static constexpr bool reports_outcomes = true;
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
  const Driver::Counters& counters() const { return driver_.counters(); }
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
