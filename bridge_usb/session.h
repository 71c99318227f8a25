/// Session: the bridge's side of docs/internals/serial-protocol.md. Here is how a session begins,
/// goes on at another rate, and ends; what goes down and up within one is session_down.h's and
/// session_up.h's.
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
#include "pc_filter.h"
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
        filter_(),
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

  // how a session begins, goes on and ends
  void hello(const uint8_t* body, uint8_t length);
  void set_session(uint32_t session) {
    session_ = session;
    reader_.expect(session);
  }
  void heard();
  void end();
  Status set_speed(const uint8_t* payload);
  void change_speed();

  // down
  void serve(const uint8_t* body, uint8_t length);
  void take_frame(const uint8_t* body, uint8_t length);
  bool refuse(uint8_t token, Status status);
  void notice_sequence(uint8_t sequence);
  void control(serial::Down operation, const uint8_t* payload, uint8_t length);
  void reply_to(uint8_t request, Status status);
  Status set_bus(const uint8_t* payload);
  void echo(const uint8_t* payload, uint8_t length);

  // up
  uint8_t put_head(const Mcp2515Frame& frame, bool remote, uint16_t ticks);
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
  PcFilter filter_;
  uint8_t head_[serial::frame_head_up + 1];  // not on the stack, which an AVR is slow at
};

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
    can_.begin_session();
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
  can_.begin_session();
  wanted_ = 0;
  change_ = Change::none;
  line_.set_rate(serial::base_rate_bps);
  line_.release();
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

}  // namespace bridge
}  // namespace roio

#include "session_down.h"
#include "session_up.h"

#endif
