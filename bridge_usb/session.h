/// Session: the bridge's side of docs/serial-protocol.md.
///
/// Up: frames are numbered as they come; one that finds no room is left out, and its number shows
/// that. Down: frames are taken in order, once. Answers that find no room wait for it, one of each
/// kind: each says what is so when it goes.
#ifndef ROIO_BRIDGE_SESSION_H
#define ROIO_BRIDGE_SESSION_H

#include "can_side.h"
#include "indicator.h"
#include "line.h"
#include "own_node.h"
#include "tally.h"

namespace roio {
namespace bridge {

class Session {
 public:
  Session(Line& line, CanSide& can, Tally& tally, OwnNode& node, Indicator& indicator, Clock& clock)
      : line_(line),
        can_(can),
        tally_(tally),
        node_(node),
        indicator_(indicator),
        clock_(clock),
        session_(serial::no_session),
        welcomed_(serial::no_session),
        due_(0),
        previous_(serial::no_session),
        previous_due_(0),
        next_(0),
        gap_told_(false),
        wanted_(0),
        reply_request_(0),
        reply_status_(Status::ok),
        change_(Change::none),
        new_rate_bps_(0),
        heard_at_(0),
        everything_passes_(true),
        rule_count_(0),
        rules_() {}

  bool is_open() const { return session_ != serial::no_session; }

  /// Takes in one byte from the PC.
  void take(uint8_t byte) {
    switch (reader_.take(byte)) {
      case serial::RecordReader::Event::none:
        return;
      case serial::RecordReader::Event::damaged:
        ++tally_.damaged;
        return;
      case serial::RecordReader::Event::record:
        break;
    }
    const uint8_t first = reader_.body()[0];
    if (!reader_.is_intact(serial::session_of(first, session_))) {
      ++tally_.damaged;
      return;
    }
    if (first == static_cast<uint8_t>(serial::Down::hello)) {
      hello(reader_.body(), reader_.length());
    } else if (is_open()) {
      heard();
      serve(reader_.body(), reader_.length());
    }
  }

  /// A frame from the bus, and when it was read.
  void forward(const Mcp2515Frame& frame, uint16_t ticks);

  /// What goes by time, and what waits for room.
  void tend();

 private:
  using Writer = serial::RecordWriter<Line>;

  // Answers that wait for room.
  static constexpr uint8_t welcome = 0x01;
  static constexpr uint8_t reply = 0x02;
  static constexpr uint8_t results = 0x04;
  static constexpr uint8_t results_again = 0x08;
  static constexpr uint8_t status = 0x10;
  static constexpr uint8_t counters = 0x20;
  /// What frames leave free for them.
  static constexpr uint8_t reserve = serial::results_length + serial::check_length + 2;
  static constexpr uint8_t record_overhead = serial::check_length + 2;

  enum class Change : uint8_t { none, draining, on_trial };

  struct Rule {
    uint32_t match;
    uint32_t mask;
  };

  void hello(const uint8_t* body, uint8_t length);
  void heard();
  void end();
  void serve(const uint8_t* body, uint8_t length);
  void take_frame(const uint8_t* body, uint8_t length);
  void notice_sequence(uint8_t sequence);
  void control(serial::Down operation, const uint8_t* payload, uint8_t length);
  void answer(uint8_t request, Status status);
  Status set_bus(const uint8_t* payload);
  Status set_filter(const uint8_t* payload, uint8_t length);
  Status set_speed(const uint8_t* payload);
  void echo(const uint8_t* payload, uint8_t length);
  bool passes(const uint8_t* tag_bytes) const;
  uint8_t put_body(const Mcp2515Frame& frame, uint16_t ticks, uint8_t* body) const;
  void tend_speed(uint16_t now);
  void send_answers();
  void send_welcome();
  void send_status();
  void send_counters();
  void send_results();
  void begin_control(Writer& writer, serial::Up operation) const {
    writer.put(static_cast<uint8_t>(operation));
    writer.put(static_cast<uint8_t>(due_));
  }
  bool has_room(uint8_t body_length) const {
    return line_.room() >= static_cast<uint8_t>(body_length + record_overhead);
  }

  Line& line_;
  CanSide& can_;
  Tally& tally_;
  OwnNode& node_;
  Indicator& indicator_;
  Clock& clock_;
  serial::RecordReader reader_;
  uint32_t session_;
  uint32_t welcomed_;  // the session that due_ belongs to, also after its end
  uint32_t due_;
  uint32_t previous_;
  uint32_t previous_due_;
  uint8_t next_;  // sequence down
  bool gap_told_;
  uint8_t wanted_;
  uint8_t reply_request_;
  Status reply_status_;
  Change change_;
  uint32_t new_rate_bps_;
  uint16_t heard_at_;
  bool everything_passes_;
  uint8_t rule_count_;
  Rule rules_[serial::max_rules];
};

// --- sessions ------------------------------------------------------------------------------------

inline void Session::hello(const uint8_t* body, uint8_t length) {
  const uint32_t session = serial::get32(body + serial::control_head + 1);
  if (length < serial::hello_length || session == serial::no_session) {
    ++tally_.damaged;
    return;
  }
  const bool speaks_this = body[serial::control_head] == serial::protocol_version;
  // One that is repeated: WELCOME was lost, or is on its way. Nothing may be counted twice.
  if (session != welcomed_) {
    previous_ = welcomed_;
    previous_due_ = due_;
    welcomed_ = session;
    due_ = 0;
    next_ = 0;
    gap_told_ = false;
    wanted_ = 0;
    can_.slots().begin_session();
  }
  session_ = speaks_this ? session : serial::no_session;
  wanted_ |= welcome;
  heard();
}

/// An intact record has come.
inline void Session::heard() {
  heard_at_ = clock_.coarse();
  if (change_ == Change::on_trial) {
    change_ = Change::none;
    line_.release();
  }
}

inline void Session::end() {
  session_ = serial::no_session;
  wanted_ = 0;
  change_ = Change::none;
  line_.set_rate(serial::base_rate_bps);
  line_.release();
}

// --- down ----------------------------------------------------------------------------------------

inline void Session::serve(const uint8_t* body, uint8_t length) {
  if (!serial::is_control(body[0])) {
    take_frame(body, length);
    return;
  }
  notice_sequence(body[1]);
  control(static_cast<serial::Down>(body[0]), body + serial::control_head,
          static_cast<uint8_t>(length - serial::control_head));
}

/// Frames that should have come by now, and have not.
inline void Session::notice_sequence(uint8_t sequence) {
  const uint8_t ahead = static_cast<uint8_t>(sequence - next_);
  if (ahead != 0 && ahead < 0x80 && !gap_told_) {
    gap_told_ = true;
    wanted_ |= results_again;
  }
}

inline void Session::take_frame(const uint8_t* body, uint8_t length) {
  Frame frame;
  if (!serial::read_frame(body, length, serial::frame_head_down, frame)) {
    ++tally_.damaged;
    return;
  }
  const uint8_t sequence = body[serial::sequence_at];
  if (sequence != next_) {
    notice_sequence(sequence);
    return;
  }
  Slots& slots = can_.slots();
  const uint8_t token = slots.token_of(sequence);
  slots.begin(token);
  const Status status = can_.send(frame, token);
  if (status != Status::ok) {
    slots.end(token, serial::Outcome::not_sent);
    if (status == Status::full || status == Status::no_chip) {
      return;  // not taken: the PC sends it again when it has waited long enough
    }
  }
  next_ = static_cast<uint8_t>(next_ + 1U);
  gap_told_ = false;
  wanted_ |= results;
}

inline void Session::control(serial::Down operation, const uint8_t* payload, uint8_t length) {
  if (operation == serial::Down::poll && length == 1) {
    wanted_ |= status;
    if (payload[0] != 0) {
      wanted_ |= counters;
    }
    if (can_.slots().any_pending()) {
      wanted_ |= results;
    }
    return;
  }
  if (operation == serial::Down::echo) {
    echo(payload, length);
    return;
  }
  if (length == 0) {
    ++tally_.damaged;
    return;
  }
  const uint8_t request = payload[0];
  const uint8_t rest = static_cast<uint8_t>(length - 1U);
  ++payload;
  Status result = Status::bad_argument;
  switch (operation) {
    case serial::Down::bus:
      if (rest == 5) {
        result = set_bus(payload);
      }
      break;
    case serial::Down::filter:
      result = set_filter(payload, rest);
      break;
    case serial::Down::address:
      if (rest == 2) {
        result = node_.set_address(Address{payload[0], payload[1]});
      }
      break;
    case serial::Down::identify:
      if (rest == 1) {
        indicator_.identify(payload[0]);
        result = Status::ok;
      }
      break;
    case serial::Down::speed:
      if (rest == 4) {
        result = set_speed(payload);
      }
      break;
    case serial::Down::bye:
      if (rest == 0) {
        change_ = Change::draining;
        new_rate_bps_ = 0;
        result = Status::ok;
      }
      break;
    default:
      break;
  }
  answer(request, result);
}

inline void Session::answer(uint8_t request, Status result) {
  reply_request_ = request;
  reply_status_ = result;
  wanted_ |= reply;
}

inline Status Session::set_bus(const uint8_t* payload) {
  return can_.configure(serial::get32(payload), static_cast<serial::Mode>(payload[4]));
}

inline Status Session::set_filter(const uint8_t* payload, uint8_t length) {
  const uint8_t count = length == 0 ? uint8_t{0xFF} : payload[0];
  if (count > serial::max_rules || length != 1 + count * sizeof(Rule)) {
    return Status::bad_argument;
  }
  rule_count_ = count;
  everything_passes_ = false;
  ++payload;
  for (uint8_t i = 0; i < count; ++i) {
    rules_[i].match = serial::get32(payload);
    rules_[i].mask = serial::get32(payload + 4);
    payload += sizeof(Rule);
    everything_passes_ = everything_passes_ || rules_[i].mask == 0;
  }
  return Status::ok;
}

inline Status Session::set_speed(const uint8_t* payload) {
  const uint32_t rate_bps = serial::get32(payload);
  for (uint8_t i = 0; i < serial::rate_count; ++i) {
    if (serial::rate_bps(i) == rate_bps) {
      new_rate_bps_ = rate_bps;
      change_ = Change::draining;
      return Status::ok;
    }
  }
  return Status::bad_argument;
}

inline void Session::echo(const uint8_t* payload, uint8_t length) {
  if (!has_room(static_cast<uint8_t>(serial::control_head + length))) {
    return;  // the PC asks again
  }
  Writer writer(line_, session_);
  begin_control(writer, serial::Up::echoed);
  for (uint8_t i = 0; i < length; ++i) {
    writer.put(payload[i]);
  }
  line_.commit(writer.finish());
}

// --- up ------------------------------------------------------------------------------------------

inline bool Session::passes(const uint8_t* tag_bytes) const {
  const uint32_t tag = serial::get32(tag_bytes);
  for (uint8_t i = 0; i < rule_count_; ++i) {
    if (((tag ^ rules_[i].match) & rules_[i].mask) == 0) {
      return true;
    }
  }
  return false;
}

/// The body of a frame's record, from the chip's bytes: no word is ever put together, which an AVR
/// would do byte by byte and bit by bit.
/// @return its length.
inline uint8_t Session::put_body(const Mcp2515Frame& frame, uint16_t ticks, uint8_t* body) const {
  const uint8_t* chip = frame.bytes;
  const bool remote = frame.is_remote();
  if (frame.is_extended()) {
    body[0] = static_cast<uint8_t>((remote ? 0xC0 : 0x80) | (chip[0] >> 3));
    body[1] = static_cast<uint8_t>((chip[0] << 5) | ((chip[1] >> 3) & 0x1C) | (chip[1] & 0x03));
    body[2] = chip[2];
    body[3] = chip[3];
  } else {
    body[0] = remote ? 0x40 : 0x00;
    body[1] = 0;
    body[2] = static_cast<uint8_t>(chip[0] >> 5);
    body[3] = static_cast<uint8_t>((chip[0] << 3) | (chip[1] >> 5));
  }
  body[serial::sequence_at] = static_cast<uint8_t>(due_);
  body[serial::time_at] = static_cast<uint8_t>(ticks >> 8);
  body[serial::time_at + 1] = static_cast<uint8_t>(ticks);
  const uint8_t length = frame.length();
  uint8_t* payload = body + serial::frame_head_up;
  if (remote) {
    *payload = length;
    return serial::frame_head_up + 1;
  }
  for (uint8_t i = 0; i < length; ++i) {
    payload[i] = frame.data()[i];
  }
  return static_cast<uint8_t>(serial::frame_head_up + length);
}

ROIO_BRIDGE_FAST inline void Session::forward(const Mcp2515Frame& frame, uint16_t ticks) {
  uint8_t body[serial::frame_head_up + max_data_length];
  const uint8_t length = put_body(frame, ticks, body);
  if (!everything_passes_ && !passes(body)) {
    return;
  }
  ++due_;
  if (!is_open()) {
    return;
  }
  if (!has_room(static_cast<uint8_t>(length + reserve))) {
    ++tally_.dropped;
    return;
  }
  line_.commit(serial::write_record(line_, session_, body, length));
}

inline void Session::tend() {
  if (!is_open() && wanted_ == 0) {
    return;
  }
  const uint16_t now = clock_.coarse();
  if (can_.slots().take_news()) {
    wanted_ |= results;
  }
  if (wanted_ != 0) {
    send_answers();
  }
  if (change_ != Change::none) {
    tend_speed(now);
  }
  if (is_open() &&
      static_cast<uint16_t>(now - heard_at_) >= Clock::coarse_of_ms(serial::pc_silence_ms)) {
    end();
  }
}

inline void Session::tend_speed(uint16_t now) {
  if (change_ == Change::draining) {
    if ((wanted_ & reply) != 0 || !line_.is_drained()) {
      return;
    }
    if (new_rate_bps_ == 0) {
      end();
      return;
    }
    line_.set_rate(new_rate_bps_);
    line_.hold();
    change_ = Change::on_trial;
    heard_at_ = now;
  } else if (static_cast<uint16_t>(now - heard_at_) >=
             Clock::coarse_of_ms(serial::speed_trial_ms)) {
    end();
  }
}

inline void Session::send_answers() {
  if ((wanted_ & welcome) != 0 && has_room(serial::welcome_length)) {
    wanted_ &= static_cast<uint8_t>(~welcome);
    send_welcome();
  }
  if ((wanted_ & reply) != 0 && has_room(serial::reply_length)) {
    wanted_ &= static_cast<uint8_t>(~reply);
    Writer writer(line_, session_);
    begin_control(writer, serial::Up::reply);
    writer.put(reply_request_);
    writer.put(static_cast<uint8_t>(reply_status_));
    line_.commit(writer.finish());
  }
  if ((wanted_ & (results | results_again)) != 0 && has_room(serial::results_length)) {
    send_results();
    wanted_ &= static_cast<uint8_t>(~(results | results_again));
  }
  if ((wanted_ & status) != 0 && has_room(serial::status_length)) {
    wanted_ &= static_cast<uint8_t>(~status);
    send_status();
  }
  if ((wanted_ & counters) != 0 && has_room(serial::counters_length)) {
    wanted_ &= static_cast<uint8_t>(~counters);
    send_counters();
  }
}

inline void Session::send_welcome() {
  Writer writer(line_, serial::no_session);
  begin_control(writer, serial::Up::welcome);
  writer.put(serial::protocol_version);
  writer.put32(welcomed_);
  writer.put32(previous_);
  writer.put32(previous_due_);
  writer.put(ROIO_VERSION_MAJOR);
  writer.put(ROIO_VERSION_MINOR);
  writer.put(ROIO_VERSION_PATCH);
  writer.put(static_cast<uint8_t>(board));
  writer.put(static_cast<uint8_t>((Line::rate_matters ? serial::rate_matters : 0U) |
                                  (can_.interrupt_is_wired() ? serial::interrupt_is_wired : 0U)));
  writer.put(serial::window);
  writer.put16(static_cast<uint16_t>(can_.osc_hz() / 1000U));
  writer.put32(can_.bitrate_bps());
  writer.put(static_cast<uint8_t>(can_.mode()));
  writer.put(node_.address().subnet);
  writer.put(node_.address().node);
  writer.put((1U << serial::rate_count) - 1U);
  line_.commit(writer.finish());
}

inline void Session::send_status() {
  uint8_t transmit = 0;
  uint8_t receive = 0;
  can_.read_error_counters(transmit, receive);
  Writer writer(line_, session_);
  begin_control(writer, serial::Up::status);
  writer.put32(clock_.ticks());
  writer.put32(due_);
  writer.put(static_cast<uint8_t>(can_.state()));
  writer.put(transmit);
  writer.put(receive);
  line_.commit(writer.finish());
}

inline void Session::send_counters() {
  Writer writer(line_, session_);
  begin_control(writer, serial::Up::counters);
  for (uint8_t i = 0; i < serial::counter_count; ++i) {
    writer.put32(tally_.value(i));
  }
  line_.commit(writer.finish());
}

inline void Session::send_results() {
  Writer writer(line_, session_);
  begin_control(writer, serial::Up::results);
  writer.put(next_);
  writer.put((wanted_ & results_again) != 0 ? serial::again : uint8_t{0});
  for (uint8_t n = 4; n-- != 0;) {
    writer.put(can_.slots().byte(n));
  }
  line_.commit(writer.finish());
}

}  // namespace bridge
}  // namespace roio

#endif
