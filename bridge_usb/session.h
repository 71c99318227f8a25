/// Session: the bridge's side of docs/internals/serial-protocol.md.
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
        has_record_(false),
        wanted_(0),
        next_counter_(0),
        reply_request_(0),
        reply_status_(Status::ok),
        change_(Change::none),
        new_rate_bps_(0),
        heard_at_(0),
        everything_passes_(true),
        rule_count_(0),
        rules_(),
        head_() {}

  bool is_open() const { return session_ != serial::no_session; }

  /// Takes in bytes from the PC, up to the end of a record; then serve() comes first.
  /// @param count how many there are; becomes how many were taken.
  ROIO_BRIDGE_FAST void take(const uint8_t* bytes, uint8_t& count) {
    const serial::RecordReader::Event event = reader_.take(bytes, count);
    if (event == serial::RecordReader::Event::damaged) {
      ++tally_.damaged;
    }
    has_record_ = event == serial::RecordReader::Event::record;
  }
  bool has_record() const { return has_record_; }

  /// Does what the record says that take() has found.
  ROIO_BRIDGE_FAST void serve() {
    has_record_ = false;
    const uint8_t* const body = reader_.body();
    if (!reader_.is_intact(serial::session_of(body[0], session_))) {
      ++tally_.damaged;
    } else if (body[0] == static_cast<uint8_t>(serial::Down::hello)) {
      hello(body, reader_.length());
    } else if (is_open()) {
      heard();
      serve(body, reader_.length());
    }
  }

  /// A frame from the bus, and when it was read.
  void forward(const Mcp2515Frame& frame, uint16_t ticks);

  /// To be called often: what waits for room, or has become worth telling.
  void answer();
  /// To be called every millisecond: what goes by time.
  void tend();

 private:
  // Answers that wait for room.
  static constexpr uint8_t welcome = 0x01;
  static constexpr uint8_t reply = 0x02;
  static constexpr uint8_t results = 0x04;
  static constexpr uint8_t results_again = 0x08;
  static constexpr uint8_t status = 0x10;
  static constexpr uint8_t counters = 0x20;
  /// What frames leave free for them.
  static constexpr uint8_t reserve = serial::results_length + serial::check_length + 2;
  /// With that much room in the line it is quiet.
  static constexpr uint8_t quiet_room = 255 - 2 * serial::max_record / 3;
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
  void set_session(uint32_t session) {
    session_ = session;
    reader_.expect(session);
  }
  static bool read_body(const uint8_t* body, uint8_t length, Mcp2515Frame& frame);
  void notice_sequence(uint8_t sequence);
  void control(serial::Down operation, const uint8_t* payload, uint8_t length);
  void reply_to(uint8_t request, Status status);
  Status set_bus(const uint8_t* payload);
  Status set_filter(const uint8_t* payload, uint8_t length);
  Status set_speed(const uint8_t* payload);
  void echo(const uint8_t* payload, uint8_t length);
  bool passes(const uint8_t* tag_bytes) const;
  uint8_t put_head(const Mcp2515Frame& frame, bool remote, uint16_t ticks);
  void change_speed();
  void send_answers();
  void send_welcome();
  void send_status();
  void send_counters();
  void send_results();
  void write(uint32_t session, const uint8_t* body, uint8_t length, const uint8_t* more = nullptr,
             uint8_t more_length = 0);
  void begin(serial::Body& body, serial::Up operation) const {
    body.put(static_cast<uint8_t>(operation));
    body.put(static_cast<uint8_t>(due_));
  }
  void write(const serial::Body& body) { write(session_, body.bytes(), body.length()); }
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
  bool has_record_;
  uint8_t wanted_;
  uint8_t next_counter_;
  uint8_t reply_request_;
  Status reply_status_;
  Change change_;
  uint32_t new_rate_bps_;
  uint16_t heard_at_;
  bool everything_passes_;
  uint8_t rule_count_;
  Rule rules_[serial::max_rules];
  uint8_t head_[serial::frame_head_up + 1];  // not on the stack, which an AVR is slow at
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
    if (change_ == Change::draining) {
      change_ = Change::none;  // what the session before has asked for
    }
    can_.slots().begin_session();
  }
  set_session(speaks_this ? session : serial::no_session);
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
  set_session(serial::no_session);
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

/// The chip's bytes of a frame, from the body of its record: put_body() the other way round.
/// @return false: none that a bus carries.
inline bool Session::read_body(const uint8_t* body, uint8_t length, Mcp2515Frame& frame) {
  const uint8_t kind = body[0] & serial::control_bits;
  const uint8_t payload = static_cast<uint8_t>(length - serial::frame_head_down);
  uint8_t* chip = frame.bytes;
  if (length < serial::frame_head_down || (kind & 0x20) != 0) {
    return false;
  }
  if ((kind & 0x80) != 0) {
    chip[0] = static_cast<uint8_t>((body[0] << 3) | (body[1] >> 5));
    chip[1] = static_cast<uint8_t>(((body[1] << 3) & 0xE0) | Mcp2515Frame::extended_bit |
                                   (body[1] & 0x03));
    chip[2] = body[2];
    chip[3] = body[3];
  } else {
    if ((body[0] & 0x1F) != 0 || body[1] != 0 || body[2] > 7) {
      return false;
    }
    chip[0] = static_cast<uint8_t>((body[2] << 5) | (body[3] >> 3));
    chip[1] = static_cast<uint8_t>(body[3] << 5);
    chip[2] = 0;
    chip[3] = 0;
  }
  body += serial::frame_head_down;
  if ((kind & 0x40) != 0) {
    chip[4] = static_cast<uint8_t>(*body | Mcp2515Frame::remote_bit);
    return payload == 1 && *body <= max_data_length;
  }
  if (payload > max_data_length) {
    return false;
  }
  chip[4] = payload;
  uint8_t* data = frame.data();
  for (uint8_t left = payload; left != 0; --left) {
    *data++ = *body++;
  }
  return true;
}

ROIO_BRIDGE_FAST inline void Session::take_frame(const uint8_t* body, uint8_t length) {
  Mcp2515Frame frame;
  if (!read_body(body, length, frame)) {
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
  slots.add_news();
}

inline void Session::control(serial::Down operation, const uint8_t* payload, uint8_t length) {
  if (operation == serial::Down::poll && length == 1) {
    wanted_ |= status | results;
    if (payload[0] != 0) {
      wanted_ |= counters;
      next_counter_ = 0;
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
  reply_to(request, result);
}

inline void Session::reply_to(uint8_t request, Status result) {
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
  serial::Body head;
  begin(head, serial::Up::echoed);
  write(session_, head.bytes(), head.length(), payload, length);
}

// --- up ------------------------------------------------------------------------------------------

/// There is room.
ROIO_BRIDGE_FAST __attribute__((noinline)) inline void Session::write(uint32_t session,
                                                                      const uint8_t* body,
                                                                      uint8_t length,
                                                                      const uint8_t* more,
                                                                      uint8_t more_length) {
  line_.commit(serial::write_record(line_.sink(), session, body, length, more, more_length));
}

ROIO_BRIDGE_FAST inline bool Session::passes(const uint8_t* tag_bytes) const {
  const uint32_t tag = serial::get32(tag_bytes);
  for (uint8_t i = 0; i < rule_count_; ++i) {
    if (((tag ^ rules_[i].match) & rules_[i].mask) == 0) {
      return true;
    }
  }
  return false;
}

/// Into head_: a frame's record but for its data, from the chip's bytes: no word is ever put
/// together, which an AVR would do byte by byte and bit by bit.
/// @return its length.
inline uint8_t Session::put_head(const Mcp2515Frame& frame, bool remote, uint16_t ticks) {
  const uint8_t first = frame.bytes[0];
  const uint8_t second = frame.bytes[1];
  uint8_t kind = remote ? 0x40 : 0x00;
  if (frame.is_extended()) {
    const uint8_t high = first >> 3;
    const uint8_t middle = static_cast<uint8_t>(first << 5);
    const uint8_t low = second >> 3;
    kind |= 0x80;
    head_[0] = kind | high;
    head_[1] = static_cast<uint8_t>(middle | (low & 0x1C) | (second & 0x03));
    head_[2] = frame.bytes[2];
    head_[3] = frame.bytes[3];
  } else {
    head_[0] = kind;
    head_[1] = 0;
    head_[2] = static_cast<uint8_t>(first >> 5);
    head_[3] = static_cast<uint8_t>((first << 3) | (second >> 5));
  }
  head_[serial::sequence_at] = static_cast<uint8_t>(due_);
  head_[serial::time_at] = static_cast<uint8_t>(ticks >> 8);
  head_[serial::time_at + 1] = static_cast<uint8_t>(ticks);
  head_[serial::frame_head_up] = frame.length();  // in place of data
  return remote ? serial::frame_head_up + 1 : serial::frame_head_up;
}

ROIO_BRIDGE_FAST inline void Session::forward(const Mcp2515Frame& frame, uint16_t ticks) {
  const bool remote = frame.is_remote();
  const uint8_t head_length = put_head(frame, remote, ticks);
  const uint8_t data_length = remote ? uint8_t{0} : frame.length();
  if (!everything_passes_ && !passes(head_)) {
    return;
  }
  ++due_;
  if (!is_open()) {
    return;
  }
  // A line that is to change its rate has to run empty, and WELCOME needs more room than a frame.
  if (change_ == Change::draining || (wanted_ & welcome) != 0 ||
      !has_room(static_cast<uint8_t>(head_length + data_length + reserve))) {
    ++tally_.dropped;
    return;
  }
  write(session_, head_, head_length, frame.data(), data_length);
}

ROIO_BRIDGE_FAST inline void Session::answer() {
  if (can_.slots().is_news_due(line_.room() < quiet_room) && is_open()) {
    wanted_ |= results;
  }
  if (wanted_ != 0) {
    send_answers();
  }
  if (change_ == Change::draining) {
    change_speed();
  }
}

inline void Session::tend() {
  if (!is_open()) {
    return;
  }
  if (can_.slots().has_news()) {
    wanted_ |= results;
  }
  const uint16_t silence = static_cast<uint16_t>(clock_.coarse() - heard_at_);
  if (silence >= Clock::coarse_of_ms(change_ == Change::on_trial ? serial::speed_trial_ms
                                                                 : serial::pc_silence_ms)) {
    end();
  }
}

inline void Session::change_speed() {
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
  heard_at_ = clock_.coarse();
}

/// One at a time, so that the bus does not wait.
inline void Session::send_answers() {
  if ((wanted_ & welcome) != 0 && has_room(serial::welcome_length)) {
    wanted_ &= static_cast<uint8_t>(~welcome);
    send_welcome();
  } else if ((wanted_ & reply) != 0 && has_room(serial::reply_length)) {
    wanted_ &= static_cast<uint8_t>(~reply);
    serial::Body body;
    begin(body, serial::Up::reply);
    body.put(reply_request_);
    body.put(static_cast<uint8_t>(reply_status_));
    write(body);
  } else if ((wanted_ & (results | results_again)) != 0 && has_room(serial::results_length)) {
    send_results();
    wanted_ &= static_cast<uint8_t>(~(results | results_again));
  } else if ((wanted_ & status) != 0 && has_room(serial::status_length)) {
    wanted_ &= static_cast<uint8_t>(~status);
    send_status();
  } else if ((wanted_ & counters) != 0 && has_room(serial::counters_length)) {
    send_counters();
  }
}

inline void Session::send_welcome() {
  serial::Body body;
  begin(body, serial::Up::welcome);
  body.put(serial::protocol_version);
  body.put32(welcomed_);
  body.put32(previous_);
  body.put32(previous_due_);
  body.put(ROIO_VERSION_MAJOR);
  body.put(ROIO_VERSION_MINOR);
  body.put(ROIO_VERSION_PATCH);
  body.put(static_cast<uint8_t>(board));
  body.put(static_cast<uint8_t>((Line::rate_matters ? serial::rate_matters : 0U) |
                                (can_.interrupt_is_wired() ? serial::interrupt_is_wired : 0U)));
  body.put(serial::window);
  body.put16(static_cast<uint16_t>(can_.osc_hz() / 1000U));
  body.put32(can_.bitrate_bps());
  body.put(static_cast<uint8_t>(can_.mode()));
  body.put(node_.address().subnet);
  body.put(node_.address().node);
  body.put((1U << serial::rate_count) - 1U);
  write(serial::no_session, body.bytes(), body.length());
}

inline void Session::send_status() {
  uint8_t transmit = 0;
  uint8_t receive = 0;
  can_.read_error_counters(transmit, receive);
  serial::Body body;
  begin(body, serial::Up::status);
  body.put32(clock_.ticks());
  body.put32(due_);
  body.put(static_cast<uint8_t>(can_.state()));
  body.put(transmit);
  body.put(receive);
  write(body);
}

/// In parts, or the bus would wait too long.
inline void Session::send_counters() {
  serial::Body body;
  begin(body, serial::Up::counters);
  body.put(next_counter_);
  for (uint8_t i = 0; i < serial::counters_at_once && next_counter_ < serial::counter_count; ++i) {
    body.put32(tally_.value(next_counter_++));
  }
  write(body);
  if (next_counter_ == serial::counter_count) {
    next_counter_ = 0;
    wanted_ &= static_cast<uint8_t>(~counters);
  }
}

inline void Session::send_results() {
  can_.slots().take_news();
  serial::Body body;
  begin(body, serial::Up::results);
  body.put(next_);
  body.put((wanted_ & results_again) != 0 ? serial::again : uint8_t{0});
  for (uint8_t n = 4; n-- != 0;) {
    body.put(can_.slots().byte(n));
  }
  write(body);
}

}  // namespace bridge
}  // namespace roio

#endif
