/// A session and a scripted bridge at the two ends of a serial line, in simulated time. Bytes that
/// arrive at another rate than they were sent at are garbage.
#ifndef ROIO_TESTS_SERIAL_LINE_HPP
#define ROIO_TESTS_SERIAL_LINE_HPP

#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "scripted_bridge.hpp"
#include "serial/session.hpp"

namespace roio::test {

using Phase = SerialSession::Phase;
using Reply = SerialSession::Reply;

inline Frame numbered(std::uint32_t number, std::uint32_t id = 0x1000400A) {
  Frame frame{id, FrameKind::extended, 4, {}};
  for (int i = 0; i < 4; ++i) {
    frame.data[i] = static_cast<std::uint8_t>(number >> (8 * i));
  }
  return frame;
}
inline std::uint32_t number_of(const Frame& frame) {
  std::uint32_t number = 0;
  for (int i = 0; i < 4; ++i) {
    number |= static_cast<std::uint32_t>(frame.data[i]) << (8 * i);
  }
  return number;
}

class Line {
 public:
  explicit Line(SerialSettings settings = {})
      : session(std::move(settings), [this] { return ++nonce; }) {}

  /// Passes on each byte, or another, or none: the faults of the line.
  std::function<std::optional<std::uint8_t>(std::uint8_t)> down_fault;
  std::function<std::optional<std::uint8_t>(std::uint8_t)> up_fault;
  /// Called at each byte time.
  std::function<void()> at_each_step;

  void run_for(Time span) {
    const Time end = now + span;
    while (now < end) {
      step();
    }
  }
  /// @return whether it became so within the time.
  bool run_until(const std::function<bool()>& it_is_so, Time patience = 10s) {
    for (const Time end = now + patience; now < end && !it_is_so();) {
      step();
    }
    return it_is_so();
  }
  /// From begin() to a session that is ready.
  void open() {
    session.begin(now);
    ASSERT_TRUE(run_until([this] { return session.phase() == Phase::ready; }));
  }
  std::optional<Reply> reply_of(const std::function<void(SerialSession::Done)>& ask,
                                Time patience = 5s) {
    std::optional<Reply> reply;
    ask([&reply](const Reply& what) { reply = what; });
    run_until([&reply] { return reply.has_value(); }, patience);
    return reply;
  }

  /// All frames that have arrived.
  std::vector<SerialSession::Arrived> arrived;
  std::uint32_t nonce = 0x1000;
  SerialSession session;
  ScriptedBridge bridge;
  Time now = 1h;  // any zero

 private:
  void step() {
    // A byte each way takes as long as the bridge's rate says.
    now += Time(10'000'000'000 / bridge.rate_bps);
    std::vector<std::uint8_t> up;
    if (!bridge.out.empty()) {
      const auto sent = bridge.out.front();
      bridge.out.pop_front();
      std::optional<std::uint8_t> byte = sent.byte;
      if (sent.rate_bps != session.line_rate_bps()) {
        byte = static_cast<std::uint8_t>(garbage_());
      }
      if (byte && up_fault) {
        byte = up_fault(*byte);
      }
      if (byte) {
        up.push_back(*byte);
      }
    }
    session.receive(up, now);
    session.on_time(now);
    if (!session.output().empty()) {
      std::optional<std::uint8_t> byte = session.output().front();
      session.consume_output(1);
      if (session.line_rate_bps() != bridge.rate_bps) {
        byte = static_cast<std::uint8_t>(garbage_());
      }
      if (byte && down_fault) {
        byte = down_fault(*byte);
      }
      if (byte) {
        bridge.take(*byte, now);
      }
    }
    bridge.on_time(now);
    for (const auto& one : session.take_arrived()) {
      arrived.push_back(one);
    }
    if (at_each_step) {
      at_each_step();
    }
  }

  std::mt19937 garbage_{7};
};

/// Loses records of the given operation, once or for ever, on their way up.
inline std::function<bool(const Bytes&)> losing(serial::Up operation, int times = 1) {
  return [operation, times](const Bytes& body) mutable {
    return body[0] != static_cast<std::uint8_t>(operation) || times-- <= 0;
  };
}

}  // namespace roio::test

#endif
