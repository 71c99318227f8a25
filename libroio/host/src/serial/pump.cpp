#include "serial/pump.hpp"

#include <algorithm>
#include <array>

namespace roio::serial {

bool send_output(SerialPort& port, SerialSession& session) {
  if (port.rate_bps() != session.line_rate_bps() && !port.set_rate(session.line_rate_bps())) {
    return false;
  }
  while (!session.output().empty()) {
    const auto count = port.write(session.output());
    if (!count) {
      return false;
    }
    if (*count == 0) {
      return true;
    }
    session.consume_output(*count);
  }
  return true;
}

bool exchange(SerialPort& port, SerialSession& session) {
  std::array<std::uint8_t, 4096> buffer{};
  const auto count = port.read(buffer);
  if (!count) {
    return false;
  }
  const Time now = steady_now();
  session.receive(std::span(buffer).first(*count), now);
  session.on_time(now);
  return send_output(port, session);
}

int poll_ms(Time deadline) {
  if (deadline == Time::max()) {
    return -1;
  }
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - steady_now()).count();
  return static_cast<int>(std::clamp<decltype(left)>(left, 0, 1000));
}

}  // namespace roio::serial
