/// Session, what goes to the PC: frames from the bus, answers and reports. Included by session.h.
#ifndef ROIO_BRIDGE_SESSION_UP_H
#define ROIO_BRIDGE_SESSION_UP_H

#include "frame_body.h"
#include "session.h"

namespace roio {
namespace bridge {

/// There is room.
ROIO_BRIDGE_FAST __attribute__((noinline)) inline void Session::write(uint32_t session,
                                                                      const uint8_t* body,
                                                                      uint8_t length,
                                                                      const uint8_t* more,
                                                                      uint8_t more_length) {
  line_.commit(serial::write_record(line_.sink(), session, body, length, more, more_length));
}

/// Into head_: a frame's record but for its data.
/// @return its length.
inline uint8_t Session::put_head(const Mcp2515Frame& frame, bool remote, uint16_t ticks) {
  put_tag(frame, remote, head_);
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
  if (!filter_.everything_passes() && !filter_.passes(head_)) {
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
