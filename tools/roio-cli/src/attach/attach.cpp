#include "attach/attach.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <memory>
#include <roio/bridge.hpp>
#include <roio/bus.hpp>
#include <roio/error.hpp>
#include <roio/text.hpp>
#include <system_error>

#include "attach/forward.hpp"
#include "program/exit_status.hpp"
#include "program/interrupt.hpp"
#include "program/output.hpp"

namespace roio::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr Clock::duration look_around_every = std::chrono::milliseconds(200);
constexpr Clock::duration report_every = std::chrono::seconds(1);

/// The right to attach a bridge to an interface, held until the process ends: with two bridges of
/// one bus on it, a frame would go round for ever. An abstract socket is known, as an interface is,
/// within its network namespace.
class InterfaceClaim {
 public:
  explicit InterfaceClaim(const std::string& interface)
      : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    const std::string name = "roio-bridge-attach:" + interface;
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(&address.sun_path[1], name.data(), name.size());
    const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
    if (::bind(socket_, reinterpret_cast<const sockaddr*>(&address), length) != 0) {
      const int error = errno;
      ::close(socket_);
      if (error == EADDRINUSE) {
        throw Failure(interface +
                      ": another bridge is attached to it; give this one an interface "
                      "of its own");
      }
      throw std::system_error(error, std::generic_category(), interface);
    }
  }
  InterfaceClaim(const InterfaceClaim&) = delete;
  InterfaceClaim& operator=(const InterfaceClaim&) = delete;
  ~InterfaceClaim() { ::close(socket_); }

 private:
  int socket_;
};

std::unique_ptr<Bus> open_bus(const std::string& text, const BusUrl& url) {
  try {
    return open_until_signal(text);
  } catch (const std::system_error& error) {
    if (error.code() != Errc::no_such_interface) {
      throw;
    }
    throw UsageError(url.target + ": no such network interface; `ip link add " + url.target +
                     " type vcan; ip link set " + url.target +
                     " up` makes a virtual one, and local:NAME needs none");
  }
}

/// Says when a bus goes and comes back.
class Watch {
 public:
  explicit Watch(const NamedBus& bus) : bus_(bus) {}

  void look() {
    const BusState state = bus_.bus.state();
    if (state != state_) {
      note(bus_.name + ": bus is " + to_string(state));
      state_ = state;
    }
  }

 private:
  const NamedBus& bus_;
  BusState state_ = BusState::active;
};

class Attachment {
 public:
  Attachment(NamedBus bridge, NamedBus bus, bool verbose)
      : bridge_(std::move(bridge)), bus_(std::move(bus)), verbose_(verbose) {}

  void run() {
    wait_for_the_end();
    bridge_.bus.cancel();
    bus_.bus.cancel();
    up_.stop();
    down_.stop();
    // What was accepted and not handed over is known then.
    bridge_.bus.close();
    bus_.bus.close();
    report();
    up_.rethrow();
    down_.rethrow();
  }

 private:
  void wait_for_the_end() {
    Watch bridge(bridge_);
    Watch bus(bus_);
    Clock::time_point next_report = Clock::now() + report_every;
    while (!up_.failed() && !down_.failed() &&
           Interrupt::sleep_until(Clock::now() + look_around_every)) {
      bridge.look();
      bus.look();
      if (verbose_ && Clock::now() >= next_report) {
        report();
        next_report += report_every;
      }
    }
  }

  void report() const {
    note(up_.report());
    note(down_.report());
  }

  NamedBus bridge_;
  NamedBus bus_;
  bool verbose_;
  Forwarder up_{bridge_, bus_};
  Forwarder down_{bus_, bridge_};
};

}  // namespace

int bridge_attach(const BridgeAttachOptions& options) {
  const BusUrl url = *parse_bus_url(options.bus);
  const auto bus = open_bus(options.bus, url);
  const auto claim =
      url.kind == BusUrl::Kind::socketcan ? std::make_unique<InterfaceClaim>(url.target) : nullptr;
  const auto bridge = open_until_signal(options.port);
  const std::string port = bridge_of(*bridge)->info().port;
  note(port + ": attached to " + bus->name());
  Attachment({*bridge, port}, {*bus, bus->name()}, options.verbose).run();
  return exit_signal + Interrupt::signal();
}

}  // namespace roio::cli
