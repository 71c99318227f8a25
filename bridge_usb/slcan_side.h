/// SlcanSide: the bridge as an adapter that speaks SLCAN, while no session of Roio's protocol is
/// open. Closed, it is off the bus, as programs that use such adapters expect.
#ifndef ROIO_BRIDGE_SLCAN_SIDE_H
#define ROIO_BRIDGE_SLCAN_SIDE_H

#include "can_side.h"
#include "line.h"
#include "tally.h"

#include <roio/slcan.hpp>

#define ROIO_VERSION_DIGITS_(major, minor) #major #minor
#define ROIO_VERSION_DIGITS(major, minor) ROIO_VERSION_DIGITS_(major, minor)

namespace roio {
namespace bridge {

class SlcanSide {
 public:
  SlcanSide(Line& line, CanSide& can, Tally& tally, Clock& clock)
      : line_(line),
        can_(can),
        tally_(tally),
        clock_(clock),
        bitrate_bps_(default_bitrate_bps),
        sample_point_permille_(default_sample_point_permille(default_bitrate_bps)),
        next_(0),
        is_open_(false),
        has_times_(false),
        last_overflows_(0),
        last_dropped_(0),
        last_given_up_(0) {}

  bool is_open() const { return is_open_; }

  void take(uint8_t byte) {
    switch (reader_.take(byte)) {
      case slcan::LineReader::Event::line:
        serve(slcan::parse(reader_.text(), reader_.length()));
        break;
      case slcan::LineReader::Event::bad:
        answer(slcan::error);
        break;
      default:
        break;
    }
  }

  /// A frame from the bus. One that finds no room is counted, and F tells it.
  void forward(const Mcp2515Frame& frame) {
    char text[slcan::max_line];
    const Frame plain = mcp2515::from_chip(frame);
    const uint8_t length =
        has_times_ ? slcan::format_frame(plain, time_ms(), text) : slcan::format_frame(plain, text);
    if (!say(text, length)) {
      ++tally_.dropped;
    }
  }

  /// A session of Roio's protocol takes over.
  void leave() {
    is_open_ = false;
    if (can_.is_stopped()) {
      can_.configure(can_.bitrate_bps(), serial::Mode::normal);
    }
  }

 private:
  using Kind = slcan::Command::Kind;

  static const char* version() {
    static_assert(ROIO_VERSION_MAJOR < 10 && ROIO_VERSION_MINOR < 10, "a digit each");
    // Of the hardware, which there is one of, and of the software.
    return "10" ROIO_VERSION_DIGITS(ROIO_VERSION_MAJOR, ROIO_VERSION_MINOR);
  }

  void serve(const slcan::Command& command) {
    char text[slcan::max_line];
    switch (command.kind) {
      case Kind::frame:
        send(command.frame);
        break;
      case Kind::flags:
        say(text, slcan::format_flags(flags(), text));
        break;
      case Kind::version:
        say(text, slcan::format_about('V', version(), text));
        break;
      case Kind::serial_number:
        say(text, slcan::format_about('N', "ROIO", text));
        break;
      default:
        answer(change(command) ? slcan::ok : slcan::error);
        break;
    }
  }

  /// @return whether it was done.
  bool change(const slcan::Command& command) {
    switch (command.kind) {
      case Kind::empty:
      case Kind::no_change:
        return true;
      case Kind::open:
        return open(serial::Mode::normal);
      case Kind::listen:
        return open(serial::Mode::listen_only);
      case Kind::close:
        can_.stop();
        is_open_ = false;
        return true;
      case Kind::bitrate:
        return set_bitrate(command);
      case Kind::times_off:
      case Kind::times_on:
        has_times_ = is_open_ ? has_times_ : command.kind == Kind::times_on;
        return !is_open_;
      default:
        return false;
    }
  }

  /// After one that is refused nothing opens: who does not look at answers, as slcand, would be on
  /// the bus at another rate than it has asked for.
  bool set_bitrate(const slcan::Command& command) {
    const bool accepted =
        !is_open_ && command.bitrate_bps != 0 && can_.can_make(command.bitrate_bps);
    bitrate_bps_ = accepted ? command.bitrate_bps : 0;
    sample_point_permille_ = command.sample_point_permille;
    return accepted;
  }

  /// One that is open stays so.
  bool open(serial::Mode mode) {
    if (is_open_ || bitrate_bps_ == 0) {
      return false;
    }
    can_.begin_session();
    is_open_ = can_.configure(bitrate_bps_, sample_point_permille_, mode) == Status::ok;
    return is_open_;
  }

  bool give_to_bus(const Frame& frame) {
    Slots& slots = can_.slots();
    const uint8_t token = slots.token_of(next_);
    if (!is_open_ || slots.is_pending(token)) {
      return false;
    }
    slots.begin(token, Slots::default_life);
    if (can_.send(frame, token) != Status::ok) {
      slots.end(token, serial::Outcome::not_sent);
      return false;
    }
    ++next_;
    return true;
  }

  void send(const Frame& frame) {
    if (!give_to_bus(frame)) {
      answer(slcan::error);
      return;
    }
    const char text[] = {slcan::taken(frame.kind), slcan::ok};
    say(text, sizeof text);
  }

  /// What has been wrong since it was last asked, and what is.
  uint8_t flags() {
    // Closed, the controller is where it should be, and has no state.
    const serial::State state = can_.is_stopped() ? serial::State::active : can_.state();
    const uint32_t overflows = can_.counters().overflows;
    const uint32_t given_up = can_.counters().not_sent + can_.counters().unknown;
    const uint8_t value =
        static_cast<uint8_t>((overflows != last_overflows_ ? slcan::overrun : 0U) |
                             (tally_.dropped != last_dropped_ ? slcan::receive_full : 0U) |
                             (given_up != last_given_up_ ? slcan::transmit_full : 0U) |
                             (state == serial::State::warning ? slcan::error_warning : 0U) |
                             (state == serial::State::passive ? slcan::error_passive : 0U) |
                             (state >= serial::State::bus_off ? slcan::bus_error : 0U));
    last_overflows_ = overflows;
    last_dropped_ = tally_.dropped;
    last_given_up_ = given_up;
    return value;
  }

  uint16_t time_ms() {
    return static_cast<uint16_t>(clock_.ticks() / (1000U / serial::ticks_us) % slcan::time_span_ms);
  }

  void answer(char character) { say(&character, 1); }

  /// @return false: no room, nothing was written.
  bool say(const char* text, uint8_t length) {
    if (line_.room() < length) {
      return false;
    }
    Line::Sink sink = line_.sink();
    for (uint8_t i = 0; i < length; ++i) {
      sink.put(i, static_cast<uint8_t>(text[i]));
    }
    line_.commit(length);
    return true;
  }

  Line& line_;
  CanSide& can_;
  Tally& tally_;
  Clock& clock_;
  slcan::LineReader reader_;
  uint32_t bitrate_bps_;  // 0: one was refused
  uint16_t sample_point_permille_;
  uint8_t next_;  // slot of a frame to the bus
  bool is_open_;
  bool has_times_;
  uint32_t last_overflows_;
  uint32_t last_dropped_;
  uint32_t last_given_up_;
};

}  // namespace bridge
}  // namespace roio

#endif
