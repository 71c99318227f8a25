// What comes up to a session: each record, and what it changes.
#include <roio/serial_protocol.hpp>
#include <utility>

#include "serial/session.hpp"

namespace roio {

// All that this file is about.
using namespace serial;  // NOLINT(google-build-using-namespace)

void SerialSession::receive(std::span<const std::uint8_t> bytes, Time now) {
  for (const std::uint8_t byte : bytes) {
    if (phase_ == Phase::closed) {
      return;
    }
    const RecordReader::Event event = reader_.take(byte);
    if (event == RecordReader::Event::none) {
      continue;
    }
    if (event == RecordReader::Event::record &&
        reader_.is_intact(session_of(reader_.body()[0], session_))) {
      take_record({reader_.body(), reader_.length()}, now);
    } else {
      count_damaged(now);
    }
  }
  send_frames(now);
}

void SerialSession::take_record(std::span<const std::uint8_t> body, Time now) {
  line_rate_.note_intact();
  heard_at_ = now;
  const bool makes_sense = is_control(body[0]) ? take_control(body, now) : take_frame(body, now);
  if (!makes_sense) {
    count_damaged(now);
  }
}

/// While there is no session, anything may be on the line.
void SerialSession::count_damaged(Time now) {
  if (!in_session()) {
    return;
  }
  if (line_rate_.note_damaged()) {
    ++counters_.damaged;
  }
  step_down_if_needed(now);
}

bool SerialSession::take_control(std::span<const std::uint8_t> body, Time now) {
  const auto operation = static_cast<Up>(body[0]);
  const auto payload = body.subspan(control_head);
  if (operation == Up::welcome) {
    return take_welcome(payload, now);
  }
  if (!in_session()) {
    return true;  // WELCOME was lost; what comes before the next is as good as lost
  }
  arrivals_.expect(body[1]);
  switch (operation) {
    case Up::status:
      return take_status(payload, now);
    case Up::counters:
      return take_counters(payload);
    case Up::results:
      return take_results(payload, now);
    case Up::reply:
      return take_reply(payload, now);
    case Up::echoed:
      return take_echoed(payload, now);
    default:
      return false;
  }
}

bool SerialSession::take_frame(std::span<const std::uint8_t> body, Time now) {
  Frame frame{};
  if (!read_frame(body.data(), static_cast<std::uint8_t>(body.size()), frame_head_up, frame)) {
    return false;
  }
  if (!in_session()) {
    return true;
  }
  if (!arrivals_.take(frame, body, now)) {
    ++counters_.damaged;  // which a lower line rate would not mend
  }
  return true;
}

bool SerialSession::take_welcome(std::span<const std::uint8_t> payload, Time now) {
  if (payload.empty()) {
    return false;
  }
  if (payload[0] != protocol_version) {
    other_version_ = OtherVersion{payload[0], firmware_of(payload)};
    return true;
  }
  const std::optional<Welcome> welcome = read_welcome(payload);
  if (!welcome || welcome->session != session_) {
    return welcome.has_value();  // the answer to an old HELLO
  }
  if (phase_ == Phase::calling) {
    open_session(*welcome, now);
  } else if (!bridge_.is_still(*welcome, is_settled())) {
    lose(now);  // the board was reset, and takes this for the first it hears of the session
  } else {
    bridge_.learn(*welcome);
  }
  return true;
}

bool SerialSession::take_status(std::span<const std::uint8_t> payload, Time now) {
  const std::optional<BridgeStatus> status = read_status(payload);
  if (!status) {
    return false;
  }
  switch (arrivals_.status(status->ticks, status->due, now)) {
    case Arrivals::Told::sense:
      break;
    case Arrivals::Told::nonsense:
      return false;
    case Arrivals::Told::other_board:
      lose(now);
      return true;
  }
  counters_wanted_ = bridge_.take(*status) || counters_wanted_;
  // WELCOME came before there was a controller, and could not say what crystal it has.
  if (bridge_.has_unknown_crystal() && is_settled() && !output_.is_clogged()) {
    bridge_.note_question();
    output_.put_hello(session_);
  }
  return true;
}

bool SerialSession::take_counters(std::span<const std::uint8_t> payload) {
  const CounterReports::Event event = reports_.take(payload);
  if (event == CounterReports::Event::complete) {
    counters_wanted_ = false;
  }
  return event != CounterReports::Event::nonsense;
}

bool SerialSession::take_results(std::span<const std::uint8_t> payload, Time now) {
  if (payload.size() != results_length - control_head) {
    return false;
  }
  const auto progress = down_.results(payload[0], get32(&payload[2]));
  if (progress == DownFrames::Progress::nonsense) {
    return false;
  }
  results_.came(progress, now);
  if ((payload[1] & again) != 0 && down_.awaits_taking()) {
    line_rate_.note_damaged_down();
    down_.go_back();
    results_.started_over(now);
  }
  return true;
}

bool SerialSession::take_reply(std::span<const std::uint8_t> payload, Time now) {
  if (payload.size() != reply_length - control_head) {
    return false;
  }
  const Reply reply{Reply::Kind::answered, static_cast<Status>(payload[1])};
  if (phase_ == Phase::speeding) {
    take_speed_reply(payload[0], reply.status, now);
  } else if (requests_.answer(payload[0], reply.status)) {
    if (phase_ == Phase::ready) {
      ask_next(now);
    } else if (phase_ == Phase::setting_up && reply.is_kept()) {
      go_on(now);
    } else if (phase_ == Phase::setting_up) {
      refuse(reply.status, now);
    }
  }
  return true;  // also one to what was asked twice
}

void SerialSession::take_speed_reply(std::uint8_t number, Status status, Time now) {
  if (number != speed_request_) {
    return;
  }
  if (status == Status::ok) {
    begin_trial(now);
    return;
  }
  line_rate_.refused();
  set_up_.begin();
  go_on(now);
}

bool SerialSession::take_echoed(std::span<const std::uint8_t> payload, Time now) {
  const LineRate::Trial trial = line_rate_.take(payload);
  if (trial == LineRate::Trial::nonsense) {
    return false;
  }
  // Else one that was sent twice.
  if (phase_ == Phase::trying && trial == LineRate::Trial::failed) {
    fail_trial(now);
  } else if (phase_ == Phase::trying && trial == LineRate::Trial::passed) {
    go_on(now);
  }
  return true;
}

}  // namespace roio
