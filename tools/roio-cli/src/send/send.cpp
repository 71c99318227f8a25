#include "send/send.hpp"

#include <unistd.h>

#include <algorithm>
#include <roio/text.hpp>
#include <span>
#include <vector>

#include "form/input_line.hpp"
#include "form/line_account.hpp"
#include "form/record_format.hpp"
#include "program/exit_status.hpp"
#include "program/interrupt.hpp"
#include "program/output.hpp"
#include "send/sender.hpp"

namespace roio::cli {
namespace {

constexpr std::size_t batch_size = 64;

SenderOptions sender_options(const SendOptions& options) {
  const bool one = options.frame && options.count == 1;
  // What was recorded comes out as it was.
  return {options.bus, options.timeout, options.wait, !options.frame, one};
}

/// Sends as fast as the bus takes it, or one frame an interval.
class PacedSender {
 public:
  PacedSender(Sender& sender, std::chrono::milliseconds interval)
      : sender_(sender), interval_(interval), next_(std::chrono::steady_clock::now()) {}

  [[nodiscard]] std::uint64_t sent() const { return sender_.sent(); }

  /// As Sender::send().
  bool send(std::span<const Frame> frames) {
    if (interval_.count() == 0) {
      return sender_.send(frames);
    }
    return std::all_of(frames.begin(), frames.end(), [this](const Frame& frame) {
      const bool awake = Interrupt::sleep_until(next_);
      next_ += interval_;
      return awake && sender_.send(std::span(&frame, 1));
    });
  }

 private:
  Sender& sender_;
  std::chrono::milliseconds interval_;
  std::chrono::steady_clock::time_point next_;  // when the next frame is due
};

void send_repeatedly(PacedSender& sender, const Frame& frame, std::uint64_t count) {
  const std::vector<Frame> batch(batch_size, frame);
  const bool endless = count == 0;
  bool going = true;
  while (going && (endless || sender.sent() < count)) {
    const std::uint64_t left = endless ? batch_size : count - sender.sent();
    going = sender.send(std::span(batch).first(std::min<std::uint64_t>(left, batch_size)));
  }
}

/// Standard input, line by line.
class LineSender {
 public:
  LineSender(const SendOptions& options, PacedSender& sender)
      : options_(options), sender_(sender), reader_(STDIN_FILENO) {}

  [[nodiscard]] const LineAccount& account() const { return account_; }

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
      account_.next_line();
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
    const auto parsed = parse_input_line(line, options_.source, options_.robot.get());
    if (!parsed) {
      account_.refuse(parsed.error());
    } else if (parsed->kind == InputLine::Kind::frame) {
      see_interface(parsed->interface_name);
      pending_.push_back(parsed->frame);
    } else {
      account_.pass_over(parsed->kind);
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
    account_.tell(": the log is of several interfaces, " + quote(interface_) + " and " +
                  quote(name) + " among them; the frames of all are sent to " + options_.bus);
    several_are_told_ = true;
  }

  bool send_pending() {
    const bool going = sender_.send(pending_);
    pending_.clear();
    return going;
  }

  const SendOptions& options_;
  PacedSender& sender_;
  LineReader reader_;
  std::vector<Frame> pending_;
  std::string interface_;  // the first that a log named
  bool several_are_told_ = false;
  LineAccount account_;
};

LineAccount send_lines(const SendOptions& options, PacedSender& sender) {
  if (::isatty(STDIN_FILENO) == 1) {
    note("reading JSON messages or log lines; Ctrl-D ends");
  }
  LineSender lines(options, sender);
  lines.run();
  return lines.account();
}

int finish(const SendOptions& options, std::uint64_t sent, const LineAccount& account) {
  const int signal = Interrupt::signal();
  if (signal != 0 || !account.is_plain()) {
    note(options.bus + ": " + count_of(sent, "message") + " sent" + account.text());
  }
  if (signal != 0) {
    return exit_signal + signal;
  }
  return account.refused() > 0 ? exit_failure : exit_success;
}

}  // namespace

int send(const SendOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const SenderOptions how = sender_options(options);
  const auto bus = open_for_sending(how);
  if (!bus) {
    note(options.bus + ": nobody else was there to have 1 message");
    return exit_success;
  }
  const CancelOnSignal cancel_on_signal(*bus);
  Sender sender(*bus, options.timeout);
  LineAccount account;
  if (!wait_for_listener(how, *bus, start)) {
    return finish(options, sender.sent(), account);
  }
  PacedSender paced(sender, options.interval);
  if (options.frame) {
    send_repeatedly(paced, *options.frame, options.count);
  } else {
    account = send_lines(options, paced);
  }
  sender.close();
  return finish(options, sender.sent(), account);
}

}  // namespace roio::cli
