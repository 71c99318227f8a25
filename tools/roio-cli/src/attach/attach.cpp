#include "attach/attach.hpp"

#include <chrono>
#include <memory>
#include <roio/bridge.hpp>
#include <roio/bus.hpp>
#include <roio/error.hpp>
#include <roio/text.hpp>
#include <span>
#include <system_error>

#include "attach/claim.hpp"
#include "attach/forward.hpp"
#include "attach/ring_watch.hpp"
#include "listen/bus_watch.hpp"
#include "program/exit_status.hpp"
#include "program/interrupt.hpp"
#include "program/one_bus.hpp"
#include "program/output.hpp"

namespace roio::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr Clock::duration look_around_every = std::chrono::milliseconds(200);
constexpr Clock::duration report_every = std::chrono::seconds(1);

std::unique_ptr<Bus> open_bus(const std::string& text) {
  try {
    return open_until_signal(text);
  } catch (const std::system_error& error) {
    if (error.code() != Errc::no_such_interface) {
      throw;
    }
    const std::string interface = parse_bus_url(text)->target;
    throw UsageError(interface + ": no such network interface; `ip link add " + interface +
                     " type vcan; ip link set " + interface +
                     " up` makes a virtual one, and local:NAME needs none");
  }
}

/// It hands back each frame once, which is no ring, but looks like one.
bool is_looped_back(Bus& bus) {
  const Bridge* const bridge = bridge_of(bus);
  return bridge != nullptr && bridge->info().mode == BridgeMode::loopback;
}

/// A bridge goes by the name of its port.
std::string short_name(Bus& bus) {
  const Bridge* const bridge = bridge_of(bus);
  return bridge != nullptr ? bridge->info().port : bus.name();
}

/// Two bridges of one bus on one interface are a ring that nobody can tell beforehand.
std::unique_ptr<Claim> claim_interface(const BusUrl& one, const BusUrl& other) {
  if (one.kind != BusUrl::Kind::serial || other.kind != BusUrl::Kind::socketcan) {
    return nullptr;
  }
  return std::make_unique<Claim>(
      "roio-bridge-attach:" + other.target,
      other.target + ": another bridge is attached to it; give this one an interface of its own");
}

void refuse_one_bus(const AttachOptions& options) {
  if (is_one_bus(options.first, options.second)) {
    throw UsageError(options.first + " and " + options.second + " are one bus; expected two");
  }
}

/// Says when a bus goes and comes back. What it cannot hand on stands in the report.
BusWatch watch_of(const NamedBus& bus) {
  return {bus.bus, [&bus](const BusNews& news) {
            if (news.kind == BusNews::Kind::state) {
              note(bus.name + ": " + to_text(news));
            }
          }};
}

class Attachment {
 public:
  Attachment(NamedBus first, NamedBus second, bool verbose)
      : first_(std::move(first)), second_(std::move(second)), verbose_(verbose) {}

  void run() {
    wait_for_the_end();
    first_.bus.cancel();
    second_.bus.cancel();
    up_.stop();
    down_.stop();
    // What was accepted and not handed over is known then.
    first_.bus.close();
    second_.bus.close();
    report();
    up_.rethrow();
    down_.rethrow();
  }

 private:
  void wait_for_the_end() {
    BusWatch first = watch_of(first_);
    BusWatch second = watch_of(second_);
    Clock::time_point next_report = Clock::now() + report_every;
    while (!up_.failed() && !down_.failed() &&
           Interrupt::sleep_until(Clock::now() + look_around_every)) {
      first.look();
      second.look();
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

  void look_for_ring(std::size_t from, std::span<const Frame> frames) {
    if (may_be_ring_ && !ring_watch_.pass(from, frames, Clock::now())) {
      throw Failure(first_.name + " and " + second_.name +
                    ": frames go round: something else joins the two as well; ended, as nothing "
                    "else would end it");
    }
  }

  NamedBus first_;
  NamedBus second_;
  bool verbose_;
  bool may_be_ring_ = !is_looped_back(first_.bus) && !is_looped_back(second_.bus);
  RingWatch ring_watch_;
  Forwarder up_{first_, second_, [this](auto frames) { look_for_ring(0, frames); }};
  Forwarder down_{second_, first_, [this](auto frames) { look_for_ring(1, frames); }};
};

}  // namespace

int attach(const AttachOptions& options) {
  refuse_one_bus(options);
  const BusUrl first_url = *parse_bus_url(options.first);
  const BusUrl second_url = *parse_bus_url(options.second);
  const auto second = open_bus(options.second);
  const auto claim = claim_interface(first_url, second_url);
  const auto first = open_bus(options.first);
  const auto other_claim = claim_interface(second_url, first_url);
  const NamedBus first_named{*first, short_name(*first)};
  const NamedBus second_named{*second, short_name(*second)};
  const JointClaim joint(full_name(*first, options.first), full_name(*second, options.second),
                         first_named.name + " and " + second_named.name);
  note(first_named.name + ": attached to " + second_named.name);
  Attachment(first_named, second_named, options.verbose).run();
  return exit_signal + Interrupt::signal();
}

}  // namespace roio::cli
