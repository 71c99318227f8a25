#include "scripted_bridge.hpp"

#include <algorithm>
#include <utility>

namespace roio::test {

using namespace serial;

namespace {

constexpr auto pc_silence = std::chrono::milliseconds(pc_silence_ms);
constexpr auto speed_trial = std::chrono::milliseconds(speed_trial_ms);

}  // namespace

Bytes record_of(const Bytes& body, std::uint32_t session) {
  struct Sink {
    std::array<std::uint8_t, max_record> bytes{};
    void put(std::uint8_t offset, std::uint8_t byte) { bytes.at(offset) = byte; }
  } sink;
  RecordWriter<Sink> writer(sink, session);
  for (const std::uint8_t byte : body) {
    writer.put(byte);
  }
  const std::uint8_t length = writer.finish();
  return {sink.bytes.begin(), sink.bytes.begin() + length};
}

int ScriptedBridge::count_of(Down operation) const {
  return static_cast<int>(std::count_if(heard.begin(), heard.end(), [operation](const Bytes& body) {
    return body[0] == static_cast<std::uint8_t>(operation);
  }));
}

std::uint32_t ScriptedBridge::ticks(Time now) const {
  const double us = static_cast<double>(now.count()) / 1000 * clock_speed;
  return first_tick + static_cast<std::uint32_t>(static_cast<std::uint64_t>(us / ticks_us));
}

// --- from the PC ---------------------------------------------------------------------------------

void ScriptedBridge::take(std::uint8_t byte, Time now) {
  const auto event = reader_.take(byte);
  if (event == RecordReader::Event::none) {
    return;
  }
  if (is_deaf) {
    ++unheard;
    return;
  }
  if (event == RecordReader::Event::damaged ||
      !reader_.is_intact(session_of(reader_.body()[0], session_))) {
    ++damaged;
    return;
  }
  const Bytes body(reader_.body(), reader_.body() + reader_.length());
  if (body[0] == static_cast<std::uint8_t>(Down::hello)) {
    heard_at_ = now;
    hello(body.data(), reader_.length());
    return;
  }
  if (session_ == no_session) {
    return;
  }
  heard_at_ = now;
  if (on_trial_) {
    on_trial_ = false;
    for (const std::uint8_t one : std::exchange(held_, {})) {
      out.push_back({one, rate_bps});
    }
  }
  if (is_control(body[0])) {
    heard.push_back(body);
    control(body, now);
  } else {
    take_frame(body);
  }
}

void ScriptedBridge::hello(const std::uint8_t* body, std::uint8_t length) {
  ++hellos;
  if (length != hello_length) {
    ++damaged;
    return;
  }
  const std::uint32_t number = get32(body + 3);
  if (number != welcomed_) {
    previous_ = std::exchange(welcomed_, number);
    previous_due_ = std::exchange(due, 0);
    next_ = 0;
    gap_told_ = false;
    slots_ = 0;
  }
  session_ = number;
  Bytes payload(1, version);
  append32(payload, number);
  append32(payload, previous_);
  append32(payload, previous_due_);
  payload = payload + Bytes{0,
                            1,
                            0,
                            1,
                            flags,
                            window,
                            static_cast<std::uint8_t>(osc_khz >> 8),
                            static_cast<std::uint8_t>(osc_khz)};
  append32(payload, bitrate_bps);
  send(Up::welcome, payload + Bytes{mode, address[0], address[1], rates});
}

void ScriptedBridge::notice(std::uint8_t sequence) {
  const auto ahead = static_cast<std::uint8_t>(sequence - next_);
  if (ahead != 0 && ahead < 128 && !gap_told_) {
    gap_told_ = true;
    send_results(true);
  }
}

void ScriptedBridge::take_frame(const Bytes& body) {
  Frame frame{};
  if (!read_frame(body.data(), static_cast<std::uint8_t>(body.size()), frame_head_down, frame)) {
    ++damaged;
    return;
  }
  frame_records.push_back(body);
  const std::uint8_t sequence = body[sequence_at];
  if (sequence != next_) {
    notice(sequence);
    return;
  }
  if (may_take && !may_take(body)) {
    return;
  }
  ++next_;
  gap_told_ = false;
  put_outcome(sequence, Outcome::pending);
  waiting_.push_back({sequence, frame});
  on_bus.push_back(frame);
  if (bus_is_free) {
    finish(1);
  } else {
    send_results(false);
  }
}

void ScriptedBridge::put_outcome(std::uint8_t sequence, Outcome outcome) {
  const int shift = 2 * (sequence % 16);
  slots_ &= ~(UINT32_C(3) << shift);
  slots_ |= static_cast<std::uint32_t>(outcome) << shift;
}

void ScriptedBridge::finish(std::size_t count, Outcome outcome) {
  for (; count > 0 && !waiting_.empty(); --count) {
    put_outcome(waiting_.front().sequence, outcome);
    waiting_.pop_front();
  }
  send_results(false);
}

void ScriptedBridge::control(const Bytes& body, Time now) {
  notice(body[1]);
  const auto operation = static_cast<Down>(body[0]);
  const Bytes payload(body.begin() + control_head, body.end());
  if (operation == Down::poll) {
    send_status(now);
    if (!waiting_.empty()) {
      send_results(false);
    }
    if (payload.at(0) != 0) {
      for (std::uint32_t first = 0; first < counter_count; first += counters_at_once) {
        Bytes counters{static_cast<std::uint8_t>(first)};
        for (std::uint32_t i = first; i < first + counters_at_once && i < counter_count; ++i) {
          append32(counters, 100 + i);
        }
        send(Up::counters, counters);
      }
    }
    return;
  }
  if (operation == Down::echo) {
    send(Up::echoed, payload);
    return;
  }
  const std::optional<std::uint8_t> status = verdict ? verdict(operation) : std::uint8_t{0};
  if (!status) {
    return;
  }
  if (*status == 0 && operation == Down::bus) {
    bitrate_bps = get32(&payload.at(1));
    mode = payload.at(5);
  }
  if (*status == 0 && operation == Down::filter) {
    rules.clear();
    for (std::size_t i = 0; i < payload.at(1); ++i) {
      rules.push_back({get32(&payload.at(2 + 8 * i)), get32(&payload.at(6 + 8 * i))});
    }
  }
  send(Up::reply, {payload.at(0), *status});
  if (*status == 0 && operation == Down::speed) {
    rate_bps = get32(&payload.at(1));
    on_trial_ = true;
  }
  if (*status == 0 && operation == Down::bye) {
    end_session();
  }
}

// --- to the PC -----------------------------------------------------------------------------------

void ScriptedBridge::send_body(const Bytes& body, std::uint32_t session) {
  if (is_deaf || (may_send && !may_send(body))) {
    return;
  }
  for (const std::uint8_t byte : record_of(body, session)) {
    if (on_trial_) {
      held_.push_back(byte);
    } else {
      out.push_back({byte, rate_bps});
    }
  }
}

void ScriptedBridge::send(Up operation, const Bytes& payload) {
  Bytes body(1, static_cast<std::uint8_t>(operation));
  body.push_back(static_cast<std::uint8_t>(due));
  send_body(body + payload, session_of(body[0], session_));
}

void ScriptedBridge::send_results(bool again) {
  Bytes payload{next_, static_cast<std::uint8_t>(again ? serial::again : 0)};
  append32(payload, slots_);
  send(Up::results, payload);
}

void ScriptedBridge::send_status(Time now) {
  Bytes payload;
  append32(payload, ticks(now));
  append32(payload, due);
  payload.insert(payload.end(), {state, 5, 7});
  send(Up::status, payload);
}

void ScriptedBridge::hear(const Frame& frame, Time now, bool has_room) {
  const std::uint32_t tag = tagged_id(frame);
  if (std::none_of(rules.begin(), rules.end(),
                   [tag](const Rule& rule) { return ((tag ^ rule.match) & rule.mask) == 0; })) {
    return;
  }
  const auto sequence = static_cast<std::uint8_t>(due++);
  if (session_ == no_session || !has_room) {
    return;
  }
  Bytes body;
  append32(body, tag);
  const std::uint32_t time = ticks(now);
  body.insert(body.end(),
              {sequence, static_cast<std::uint8_t>(time >> 8), static_cast<std::uint8_t>(time)});
  if (is_remote(frame.kind)) {
    body.push_back(frame.length);
  } else {
    body.insert(body.end(), frame.data, frame.data + frame.length);
  }
  send_body(body, session_);
}

// --- by itself -----------------------------------------------------------------------------------

void ScriptedBridge::on_time(Time now) {
  if (session_ != no_session && now - heard_at_ >= (on_trial_ ? speed_trial : pc_silence)) {
    end_session();
  }
}

void ScriptedBridge::end_session() {
  session_ = no_session;
  rate_bps = base_rate_bps;
  on_trial_ = false;
  held_.clear();
}

void ScriptedBridge::reset() {
  end_session();
  out.clear();
  reader_ = RecordReader();
  welcomed_ = previous_ = previous_due_ = due = 0;
  next_ = 0;
  waiting_.clear();
  slots_ = 0;
  rules = {{0, 0}};
  bitrate_bps = 500'000;
  mode = 0;
}

}  // namespace roio::test
