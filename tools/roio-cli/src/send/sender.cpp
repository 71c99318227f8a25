#include "send/sender.hpp"

#include <algorithm>
#include <roio/error.hpp>
#include <roio/text.hpp>
#include <system_error>

#include "program/exit_status.hpp"
#include "program/interrupt.hpp"
#include "send/outcome.hpp"

namespace roio::cli {
namespace {

// How often it is asked whether somebody listens by now.
constexpr std::chrono::milliseconds look_every{5};

[[noreturn]] void fail_for_want_of_listeners(const SenderOptions& options) {
  throw Failure(options.bus + ": nobody came to listen within " +
                std::to_string(options.wait->count()) + " ms; nothing was sent");
}

}  // namespace

// Who waits for a listener, or sends one message and is gone, leaves it to others to carry the bus.
std::unique_ptr<Bus> open_for_sending(const SenderOptions& options) {
  OpenOptions open_options;
  open_options.send_only = true;
  open_options.in_order = options.in_order;
  open_options.lifetime = options.timeout;
  if (!options.wait && !options.alone) {
    return open_until_signal(options.bus, open_options);
  }
  open_options.carry = Carry::never;
  if (options.wait) {
    open_options.open_timeout = *options.wait;
  } else if (parse_bus_url(options.bus)->kind == BusUrl::Kind::local) {
    open_options.open_timeout = no_wait;
  }
  try {
    return open_until_signal(options.bus, open_options);
  } catch (const std::system_error& error) {
    if (error.code() != Errc::not_connected) {
      throw;
    }
    if (options.wait) {
      fail_for_want_of_listeners(options);
    }
    return nullptr;
  }
}

bool wait_for_listener(const SenderOptions& options, const Bus& bus,
                       std::chrono::steady_clock::time_point start) {
  if (!options.wait) {
    return true;
  }
  const auto end = start + *options.wait;
  while (bus.listeners().value_or(0) == 0) {
    const auto now = std::chrono::steady_clock::now();
    if (now >= end) {
      fail_for_want_of_listeners(options);
    }
    if (!Interrupt::sleep_until(std::min(now + look_every, end))) {
      return false;
    }
  }
  return true;
}

bool Sender::send(std::span<const Frame> frames) {
  while (!frames.empty()) {
    const Transfer transfer = bus_.send(frames, timeout_);
    sent_ += transfer.count;
    frames = frames.subspan(transfer.count);
    if (Interrupt::signal() != 0 || transfer.result == Result::cancelled) {
      return false;
    }
    // The timeout is each frame's: as long as some go out, the others may wait on.
    const bool waited_in_vain = transfer.result != Result::ok && transfer.count == 0;
    if (waited_in_vain || has_given_up(bus_)) {
      throw Failure(why_not_sent(bus_, timeout_, sent_));
    }
  }
  return true;
}

void Sender::close() {
  finish_sending(bus_, timeout_, sent_);
}

}  // namespace roio::cli
