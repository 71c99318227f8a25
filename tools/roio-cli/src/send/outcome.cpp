#include "send/outcome.hpp"

#include <roio/bridge.hpp>
#include <system_error>

#include "form/record_format.hpp"
#include "program/exit_status.hpp"
#include "program/interrupt.hpp"
#include "program/output.hpp"

namespace roio::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds look_every{5};
constexpr std::chrono::milliseconds answer_time{200};

/// As it is now: the answer to a question for the counters brings it along.
BridgeInfo latest_info(Bridge& bridge) {
  try {
    static_cast<void>(bridge.counters(answer_time));
  } catch (const std::system_error&) {
    // It does not answer: what was last known, or that it is absent, says as much.
  }
  return bridge.info();
}

/// What keeps the bridge from sending: what to read after "not sent".
std::string hindrance(const BridgeInfo& info, const std::string& within) {
  constexpr int passive_from =
      128;  // what no acknowledgement raises the counter to, and no further
  const std::string state = to_string(info.state);
  if (info.state != BridgeState::absent && info.mode == BridgeMode::listen) {
    return ": the bridge only listens";
  }
  if (info.state == BridgeState::passive && info.transmit_errors >= passive_from) {
    return within + ": nobody acknowledges, the bus is " + state;
  }
  switch (info.state) {
    case BridgeState::absent:
    case BridgeState::no_controller:
    case BridgeState::stuck:
      return within + ": the bridge says " + state;
    default:
      return within + ", the bus is " + state;
  }
}

}  // namespace

bool has_given_up(Bus& bus) {
  return bridge_of(bus) != nullptr && bus.statistics().unsent > 0;
}

void wait_for_outcomes(Bus& bus) {
  const Bridge* const bridge = bridge_of(bus);
  while (bridge != nullptr && bridge->line_counters().unsettled > 0 &&
         Interrupt::sleep_until(Clock::now() + look_every)) {
  }
}

std::string why_not_sent(Bus& bus, std::chrono::milliseconds timeout, std::uint64_t accepted) {
  const std::string within = " within " + std::to_string(timeout.count()) + " ms";
  Bridge* const bridge = bridge_of(bus);
  const std::string reason = bridge != nullptr ? hindrance(latest_info(*bridge), within)
                                               : within + ", the bus is " + to_string(bus.state());
  bus.close();
  const std::uint64_t sent = bridge != nullptr ? bridge->line_counters().sent : accepted;
  return bus.name() + ": not sent" + reason + "; " + count_of(sent, "message") + " sent before";
}

void finish_sending(Bus& bus, std::chrono::milliseconds timeout, std::uint64_t accepted) {
  wait_for_outcomes(bus);
  if (has_given_up(bus)) {
    throw Failure(why_not_sent(bus, timeout, accepted));
  }
  bus.close();
  if (const std::uint64_t unheard = bus.statistics().unheard; unheard > 0) {
    note(bus.name() + ": nobody else was there to have " + count_of(unheard, "message"));
  }
  if (const std::uint64_t unsent = bus.statistics().unsent; unsent > 0) {
    throw Failure(bus.name() + ": " + count_of(unsent, "message") +
                  " not handed over before the bus closed");
  }
}

}  // namespace roio::cli
