// The serial bus as a Bridge: what it tells of the board, and what it asks of it.
#include <algorithm>
#include <memory>
#include <roio/error.hpp>
#include <utility>

#include "serial/pump.hpp"
#include "serial/serial_bus.hpp"
#include "serial/trouble.hpp"

namespace roio::serial {
namespace {

// A bridge that is there sends its counters in milliseconds.
constexpr std::chrono::seconds counters_time{2};

/// What a condition variable can wait for.
Timeout bounded(Timeout timeout) {
  return std::clamp<Timeout>(timeout, no_wait, std::chrono::hours(1));
}

}  // namespace

BridgeInfo SerialBus::info() const {
  const std::lock_guard lock(mutex_);
  BridgeInfo info = session_.info();
  info.port = path_;
  return info;
}

BridgeLineCounters SerialBus::line_counters() const {
  const std::lock_guard lock(mutex_);
  const SerialSession::Counters& line = session_.counters();
  const DownFrames::Counters& down = session_.down();
  return {line.sessions, line.damaged,       session_.lost(), down.resent,
          line.retries,  line.failed_trials, line.step_downs, down.sent,
          down.not_sent, down.unknown,       down.dropped,    session_.unsettled()};
}

// --- requests ------------------------------------------------------------------------------------

SerialBus::Question SerialBus::bus_question(std::uint32_t bitrate_bps, BridgeMode mode) {
  return {name_ + ": bit rate " + std::to_string(bitrate_bps) + ", mode " + to_string(mode),
          [this, bitrate_bps, mode](Done done) {
            session_.set_bus(bitrate_bps, mode, steady_now(), std::move(done));
          }};
}

SerialBus::Question SerialBus::address_question(std::optional<Address> address) {
  const Address to_set = address.value_or(broadcast_of(0));
  return {name_ + ": address " + to_string(to_set), [this, to_set](Done done) {
            session_.set_address(to_set, steady_now(), std::move(done));
          }};
}

SerialBus::Question SerialBus::identify_question(std::chrono::seconds duration) {
  constexpr std::chrono::seconds longest{255};
  const auto seconds = std::clamp(duration, std::chrono::seconds(0), longest);
  return {name_ + ": identify", [this, seconds](Done done) {
            session_.identify(static_cast<std::uint8_t>(seconds.count()), steady_now(),
                              std::move(done));
          }};
}

// --- with waiting --------------------------------------------------------------------------------

void SerialBus::set_bus(std::uint32_t bitrate_bps, BridgeMode mode, Timeout timeout) {
  request(bus_question(bitrate_bps, mode), timeout);
}

void SerialBus::set_address(std::optional<Address> address, Timeout timeout) {
  request(address_question(address), timeout);
}

void SerialBus::identify(std::chrono::seconds duration, Timeout timeout) {
  request(identify_question(duration), timeout);
}

BridgeCounters SerialBus::counters(Timeout timeout) {
  Lock lock(mutex_);
  const std::uint64_t before = session_.counter_reports();
  session_.ask_counters(steady_now());
  flush();
  if (!changed_.wait_for(lock, bounded(timeout),
                         [this, before] { return session_.counter_reports() != before; })) {
    throw std::system_error(Errc::no_bridge, name_ + ": counters");
  }
  return session_.bridge_counters();
}

/// Asks, and waits for the reply.
std::optional<SerialSession::Reply> SerialBus::await_reply(Lock& lock, Timeout timeout,
                                                           const std::function<void(Done)>& ask) {
  const auto reply = std::make_shared<std::optional<Reply>>();
  ask([reply](const Reply& what) { *reply = what; });
  flush();
  changed_.wait_for(lock, bounded(timeout), [&reply] { return reply->has_value(); });
  return *reply;
}

void SerialBus::request(const Question& question, Timeout timeout) {
  Lock lock(mutex_);
  const Reply reply = await_reply(lock, timeout, question.ask).value_or(Reply{});
  if (!reply.ok()) {
    throw request_error(question.what, reply);
  }
}

// --- without -------------------------------------------------------------------------------------

std::uint32_t SerialBus::begin_set_bus(std::uint32_t bitrate_bps, BridgeMode mode) {
  return begin(bus_question(bitrate_bps, mode));
}

std::uint32_t SerialBus::begin_set_address(std::optional<Address> address) {
  return begin(address_question(address));
}

std::uint32_t SerialBus::begin_identify(std::chrono::seconds duration) {
  return begin(identify_question(duration));
}

std::uint32_t SerialBus::begin(const Question& question) {
  const std::lock_guard lock(mutex_);
  const std::uint32_t id = replies_.begin(name_);
  question.ask([this, id, what = question.what](const Reply& reply) {
    answer({id, reply.ok() ? std::nullopt : std::optional(request_error(what, reply)), {}});
  });
  flush();
  return id;
}

std::uint32_t SerialBus::begin_counters() {
  const std::lock_guard lock(mutex_);
  const std::uint32_t id = replies_.begin(name_);
  counters_asked_.push_back({id, session_.counter_reports(), Deadline(counters_time)});
  if (waits_.is_closed()) {
    answer_counters(true);
    return id;
  }
  session_.ask_counters(steady_now());
  flush();
  return id;
}

/// @param all also those that are not answered, and will not be.
void SerialBus::answer_counters(bool all) {
  std::erase_if(counters_asked_, [this, all](const CountersAsked& asked) {
    const bool answered = session_.counter_reports() != asked.reports_before;
    if (answered) {
      answer({asked.id, {}, session_.bridge_counters()});
    } else if (all || asked.until.passed()) {
      answer({asked.id, std::system_error(Errc::no_bridge, name_ + ": counters"), {}});
    } else {
      return false;
    }
    return true;
  });
}

void SerialBus::answer(BridgeReply reply) {
  replies_.finish(std::move(reply));
  events_.tell(&Events::reply);
}

std::optional<BridgeReply> SerialBus::take_reply() {
  const std::lock_guard lock(mutex_);
  return replies_.take();
}

}  // namespace roio::serial
