/// Session, what comes from the PC: frames for the bus, taken in order and once, and requests.
/// Included by session.h.
#ifndef ROIO_BRIDGE_SESSION_DOWN_H
#define ROIO_BRIDGE_SESSION_DOWN_H

#include "frame_body.h"
#include "session.h"

namespace roio {
namespace bridge {

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

ROIO_BRIDGE_FAST inline void Session::take_frame(const uint8_t* body, uint8_t length) {
  Mcp2515Frame frame;
  if (!read_frame_body(body, length, frame)) {
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
  const uint8_t life = body[serial::life_at];
  slots.begin(token, life);
  const Status status = life == 0 ? Status::empty : can_.send(frame, token);
  if (status != Status::ok && !refuse(token, status)) {
    return;  // not taken: the PC sends it again when it has waited long enough
  }
  next_ = static_cast<uint8_t>(next_ + 1U);
  gap_told_ = false;
  slots.add_news();
}

/// Of a frame that the controller does not get.
/// @return whether it is taken all the same: its outcome is known.
__attribute__((noinline)) inline bool Session::refuse(uint8_t token, Status status) {
  can_.slots().end(token, serial::Outcome::not_sent);
  if (status == Status::full || status == Status::no_chip) {
    return false;
  }
  ++tally_.refused;
  return true;
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
      result = filter_.set(payload, rest);
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

inline void Session::echo(const uint8_t* payload, uint8_t length) {
  if (!has_room(static_cast<uint8_t>(serial::control_head + length))) {
    return;  // the PC asks again
  }
  serial::Body head;
  begin(head, serial::Up::echoed);
  write(session_, head.bytes(), head.length(), payload, length);
}

}  // namespace bridge
}  // namespace roio

#endif
