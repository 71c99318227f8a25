#include "send/send.hpp"

#include <unistd.h>

#include <algorithm>
#include <roio/bridge.hpp>
#include <roio/error.hpp>
#include <roio/text.hpp>
#include <span>
#include <utility>
#include <vector>

#include "form/input_line.hpp"
#include "form/record_format.hpp"
#include "program/exit_status.hpp"
#include "program/interrupt.hpp"
#include "program/output.hpp"
#include "send/outcome.hpp"

namespace roio::cli {
namespace {

constexpr std::size_t batch_size = 64;

// How often it is asked whether somebody listens by now.
constexpr std::chrono::milliseconds look_every{5};

// So many lines are named one by one; who pipes in what is no log at all wants no more of them.
constexpr std::uint64_t max_named_lines = 10;

[[noreturn]] void fail_for_want_of_listeners(const SendOptions& options) {
  throw Failure(options.bus + ": nobody came to listen within " +
                std::to_string(options.wait->count()) + " ms; nothing was sent");
}

/// Who waits for a listener, or sends one message and is gone, leaves it to others to carry the
/// bus.
/// @return null: nobody does, and none is waited for.
std::unique_ptr<Bus> open_bus(const SendOptions& options) {
  OpenOptions open_options;
  open_options.send_only = true;
  open_options.in_order = !options.frame;  // what was recorded comes out as it was
  open_options.lifetime = options.timeout;
  const bool one = options.frame && options.count == 1;
  if (!options.wait && !one) {
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

/// @return false when a signal came first.
/// @throws Failure: nobody came.
bool wait_for_listener(const SendOptions& options, const Bus& bus,
                       std::chrono::steady_clock::time_point end) {
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

/// Sends frames in order, as fast as the bus takes them or one an interval.
class Sender {
 public:
  Sender(const SendOptions& options, Bus& bus)
      : options_(options), bus_(bus), next_(std::chrono::steady_clock::now()) {}

  [[nodiscard]] std::uint64_t sent() const { return sent_; }

  /// @return false when a signal came first.
  /// @throws Failure: a frame had to wait longer than the timeout.
  bool send(std::span<const Frame> frames) {
    if (options_.interval.count() == 0) {
      return send_now(frames);
    }
    return std::all_of(frames.begin(), frames.end(), [this](const Frame& frame) {
      const bool awake = Interrupt::sleep_until(next_);
      next_ += options_.interval;
      return awake && send_now(std::span(&frame, 1));
    });
  }

 private:
  bool send_now(std::span<const Frame> frames) {
    while (!frames.empty()) {
      const Transfer transfer = bus_.send(frames, options_.timeout);
      sent_ += transfer.count;
      frames = frames.subspan(transfer.count);
      if (Interrupt::signal() != 0 || transfer.result == Result::cancelled) {
        return false;
      }
      // The timeout is each frame's: as long as some go out, the others may wait on.
      const bool waited_in_vain = transfer.result != Result::ok && transfer.count == 0;
      if (waited_in_vain || has_given_up(bus_)) {
        throw Failure(why_not_sent(bus_, options_.timeout, sent_));
      }
    }
    return true;
  }

  const SendOptions& options_;
  Bus& bus_;
  std::chrono::steady_clock::time_point next_;  // when the next frame is due
  std::uint64_t sent_ = 0;
};

void send_repeatedly(Sender& sender, const Frame& frame, std::uint64_t count) {
  const std::vector<Frame> batch(batch_size, frame);
  const bool endless = count == 0;
  bool going = true;
  while (going && (endless || sender.sent() < count)) {
    const std::uint64_t left = endless ? batch_size : count - sender.sent();
    going = sender.send(std::span(batch).first(std::min<std::uint64_t>(left, batch_size)));
  }
}

/// Lines that were not sent.
struct Unsent {
  std::uint64_t refused = 0;
  std::uint64_t news = 0;
  std::uint64_t comments = 0;
};

/// Standard input, line by line.
class LineSender {
 public:
  LineSender(const std::string& bus, Sender& sender, Address default_source)
      : bus_(bus), sender_(sender), default_source_(default_source), reader_(STDIN_FILENO) {}

  [[nodiscard]] const Unsent& unsent() const { return unsent_; }

  void run() {
    bool more = true;
    while (more && Interrupt::wait_readable(STDIN_FILENO)) {
      more = reader_.fill();
      if (!take_lines() || !send_pending()) {
        return;
      }
    }
  }

 private:
  bool take_lines() {
    while (const auto line = reader_.next()) {
      ++line_number_;
      if (!is_blank(*line)) {
        take(*line);
      }
      if (pending_.size() == batch_size && !send_pending()) {
        return false;
      }
    }
    return true;
  }

  void take(std::string_view line) {
    const auto parsed = parse_input_line(line, default_source_);
    if (!parsed) {
      refuse(parsed.error());
      return;
    }
    switch (parsed->kind) {
      case InputLine::Kind::frame:
        see_interface(parsed->interface_name);
        pending_.push_back(parsed->frame);
        break;
      case InputLine::Kind::news:
        ++unsent_.news;
        break;
      case InputLine::Kind::comment:
        ++unsent_.comments;
        break;
    }
  }

  // A log of two buses on one is hardly what anybody wants, and may be.
  void see_interface(const std::string& name) {
    if (interface_.empty()) {
      interface_ = name;
    }
    if (name.empty() || name == interface_ || several_are_told_) {
      return;
    }
    note("line " + std::to_string(line_number_) + ": the log is of several interfaces, " +
         quote(interface_) + " and " + quote(name) + " among them; the frames of all are sent to " +
         bus_);
    several_are_told_ = true;
  }

  void refuse(const ParseError& error) {
    ++unsent_.refused;
    if (unsent_.refused <= max_named_lines) {
      note("line " + std::to_string(line_number_) + ": " + error.message);
    } else if (unsent_.refused == max_named_lines + 1) {
      note("line " + std::to_string(line_number_) +
           " and others, which are not named: their number follows at the end");
    }
  }

  bool send_pending() {
    const bool going = sender_.send(pending_);
    pending_.clear();
    return going;
  }

  const std::string& bus_;
  Sender& sender_;
  Address default_source_;
  LineReader reader_;
  std::vector<Frame> pending_;
  std::uint64_t line_number_ = 0;
  std::string interface_;  // the first that a log named
  bool several_are_told_ = false;
  Unsent unsent_;
};

Unsent send_lines(const SendOptions& options, Sender& sender) {
  if (::isatty(STDIN_FILENO) == 1) {
    note("reading JSON messages or log lines; Ctrl-D ends");
  }
  LineSender lines(options.bus, sender, options.source);
  lines.run();
  return lines.unsent();
}

std::string passed_over(const Unsent& unsent) {
  std::string text;
  for (const auto& [count, what] :
       {std::pair{unsent.news, "bus report"}, std::pair{unsent.comments, "comment"}}) {
    if (count > 0) {
      text += (text.empty() ? ", passed over: " : ", ") + count_of(count, what);
    }
  }
  return text;
}

int finish(const SendOptions& options, const Sender& sender, const Unsent& unsent) {
  std::string text = options.bus + ": " + count_of(sender.sent(), "message") + " sent";
  if (unsent.refused > 0) {
    text += ", " + count_of(unsent.refused, "line") + " refused";
  }
  text += passed_over(unsent);
  const int signal = Interrupt::signal();
  if (signal != 0 || unsent.refused > 0 || unsent.news > 0 || unsent.comments > 0) {
    note(text);
  }
  if (signal != 0) {
    return exit_signal + signal;
  }
  return unsent.refused > 0 ? exit_failure : exit_success;
}

}  // namespace

int send(const SendOptions& options) {
  const auto end =
      std::chrono::steady_clock::now() + options.wait.value_or(std::chrono::milliseconds(0));
  const auto bus = open_bus(options);
  if (!bus) {
    note(options.bus + ": nobody else was there to have 1 message");
    return exit_success;
  }
  const CancelOnSignal cancel_on_signal(*bus);
  Sender sender(options, *bus);
  Unsent unsent;
  if (options.wait && !wait_for_listener(options, *bus, end)) {
    return finish(options, sender, unsent);
  }
  if (options.frame) {
    send_repeatedly(sender, *options.frame, options.count);
  } else {
    unsent = send_lines(options, sender);
  }
  finish_sending(*bus, options.timeout, sender.sent());
  return finish(options, sender, unsent);
}

}  // namespace roio::cli
