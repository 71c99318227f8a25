#include "serial/finder.hpp"

#include <poll.h>

#include <algorithm>
#include <array>
#include <roio/bridge.hpp>
#include <roio/error.hpp>
#include <roio/parts/deadline.hpp>
#include <roio/parts/thread.hpp>
#include <thread>

#include "serial/nonce.hpp"
#include "serial/ports.hpp"
#include "serial/pump.hpp"
#include "serial/trouble.hpp"

namespace roio {
namespace serial {
namespace {

constexpr Timeout bye_time = std::chrono::milliseconds(200);

/// How long to look.
struct Limit {
  Deadline deadline;
  const EventFlag* stop = nullptr;  ///< Ends it early; null: nothing does.
};

/// Serves a session until it is so. @return false: the time was up, or the port is gone.
template <typename Condition>
bool serve_until(SerialPort& port, SerialSession& session, const Limit& limit,
                 const Condition& it_is_so) {
  const Deadline& deadline = limit.deadline;
  while (exchange(port, session)) {
    if (it_is_so()) {
      return true;
    }
    if (deadline.passed() || (limit.stop != nullptr && limit.stop->is_set())) {
      return false;
    }
    std::array<pollfd, 2> entries{
        {{port.fd(), POLLIN, 0}, {limit.stop != nullptr ? limit.stop->fd() : -1, POLLIN, 0}}};
    // A session without a deadline waits for nothing: deadline alone bounds it.
    const int patience_ms = poll_ms(session.deadline());
    static_cast<void>(
        ::poll(entries.data(), entries.size(),
               patience_ms < 0 ? deadline.poll_ms() : std::min(patience_ms, deadline.poll_ms())));
  }
  return false;
}

/// Says HELLO, listens for what the bridge is, and takes its leave; it is left as it was.
void ask(BridgePort& found, const Limit& limit) {
  SerialPort port(found.path, found.path, base_rate_bps);
  SerialSettings settings;
  settings.line_rate_bps = base_rate_bps;
  SerialSession session(settings, random_nonce);
  session.begin(steady_now());
  const bool answered = serve_until(port, session, limit, [&session] {
    return session.info().state != BridgeState::absent || session.other_version();
  });
  if (const auto trouble = trouble_of(session, found.path)) {
    found.why_not = trouble->in_short;
  } else if (answered) {
    found.bridge = session.info();
    found.bridge->port = found.path;
  } else {
    found.why_not = "no bridge answered";
  }
  session.leave(steady_now(), [](const SerialSession::Reply&) {});
  serve_until(port, session, {Deadline(bye_time)},
              [&session] { return session.phase() == SerialSession::Phase::closed; });
}

std::string why_not(const std::error_code& code, const std::string& path) {
  if (code == Errc::port_in_use) {
    return "another program has it open";
  }
  if (code == Errc::port_not_permitted) {
    return "no permission; " + how_to_be_permitted(path);
  }
  if (code == Errc::no_such_port) {
    return "no such serial port";
  }
  return code.message();
}

void look(BridgePort& found, const Limit& limit) {
  found.product = product_of(found.path);
  try {
    if (is_open_anywhere(found.path)) {
      throw std::system_error(Errc::port_in_use);
    }
    ask(found, limit);
  } catch (const std::system_error& error) {
    found.why_not = why_not(error.code(), found.path);
  }
}

std::vector<BridgePort> look_at_all_likely(const Limit& limit) {
  std::vector<BridgePort> ports;
  for (std::string& path : likely_ports()) {
    ports.push_back({std::move(path), {}, {}, {}});
  }
  std::vector<std::thread> threads;
  threads.reserve(ports.size());
  for (BridgePort& port : ports) {
    threads.push_back(start_thread([&port, &limit] { look(port, limit); }));
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  return ports;
}

/// "serial:auto: no likely port", "serial:auto (/dev/ttyACM0: no bridge answered)".
std::string about(const std::string& name, const std::vector<BridgePort>& ports) {
  if (ports.empty()) {
    return name + ": no port of a likely board";
  }
  std::string text = name + " (";
  for (const BridgePort& port : ports) {
    text += port.path + ": " + (port.bridge ? "a bridge" : port.why_not) + ", ";
  }
  text.resize(text.size() - 2);
  return text + ')';
}

}  // namespace

std::string find_the_bridge(const std::string& name, Timeout timeout, const EventFlag& stop) {
  const std::vector<BridgePort> ports = look_at_all_likely({Deadline(timeout), &stop});
  const auto is_bridge = [](const BridgePort& port) { return port.bridge.has_value(); };
  const auto first = std::find_if(ports.begin(), ports.end(), is_bridge);
  if (first == ports.end()) {
    throw std::system_error(Errc::no_bridge, about(name, ports));
  }
  if (std::count_if(ports.begin(), ports.end(), is_bridge) > 1) {
    throw std::system_error(Errc::several_bridges, about(name, ports));
  }
  return first->path;
}

}  // namespace serial

std::vector<BridgePort> find_bridges(Timeout timeout) {
  return serial::look_at_all_likely({Deadline(timeout)});
}

}  // namespace roio
