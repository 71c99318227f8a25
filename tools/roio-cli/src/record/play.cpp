#include "record/play.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "form/line_account.hpp"
#include "form/record_format.hpp"
#include "program/exit_status.hpp"
#include "program/interrupt.hpp"
#include "program/output.hpp"
#include "record/log_input.hpp"
#include "record/progress.hpp"
#include "send/send.hpp"
#include "send/sender.hpp"

namespace roio::cli {
namespace {

using Clock = Schedule::Clock;

constexpr std::size_t batch_size = 64;

// A bus that is slower than the log by less than this is as good as its clock.
constexpr std::chrono::seconds worth_a_word{1};

/// The buses that a log is played to.
class Outputs {
 public:
  explicit Outputs(const PlayOptions& options) {
    const auto start = Clock::now();
    for (const std::string& bus : options.routes.buses) {
      const SenderOptions how{bus, options.timeout, options.wait};
      buses_.push_back(open_for_sending(how));
      senders_.emplace_back(*buses_.back(), options.timeout);
      if (!wait_for_listener(how, *buses_.back(), start)) {
        return;
      }
    }
  }

  /// @return false when a signal came first.
  bool send(std::size_t bus, std::span<const Frame> frames) {
    const CancelOnSignal cancel_on_signal(*buses_[bus]);
    return senders_[bus].send(frames);
  }

  /// Each, whatever becomes of the others.
  /// @return false when one did not hand over all, which is told.
  bool close() {
    bool all_went = true;
    for (Sender& sender : senders_) {
      try {
        sender.close();
      } catch (const Failure& failure) {
        note(failure.what());
        all_went = false;
      }
    }
    return all_went;
  }

  [[nodiscard]] std::uint64_t sent() const {
    std::uint64_t sum = 0;
    for (const Sender& sender : senders_) {
      sum += sender.sent();
    }
    return sum;
  }

 private:
  std::vector<std::unique_ptr<Bus>> buses_;
  std::vector<Sender> senders_;
};

class Player {
 public:
  explicit Player(const PlayOptions& options)
      : options_(options),
        input_(options.file),
        outputs_(options),
        account_(input_.name()),
        schedule_(options.pace) {
    if (options.times != 1 && !input_.is_file()) {
      throw UsageError("--loop: expected a file, which can be read again, not " + input_.name());
    }
  }

  int run() {
    for (;;) {
      const std::uint64_t sent_before = outputs_.sent();
      play_once();
      ++pass_;
      const bool nothing_to_repeat = outputs_.sent() == sent_before;
      if (Interrupt::signal() != 0 || pass_ == options_.times || nothing_to_repeat) {
        break;
      }
      input_.begin_again();
      schedule_.begin_again();
    }
    progress_.clear();
    const bool all_went = outputs_.close();
    const int status = finish();
    return all_went ? status : exit_failure;
  }

 private:
  [[nodiscard]] bool is_going() const { return Interrupt::signal() == 0 && !is_behind_; }

  // What is there is sent before more is waited for.
  void play_once() {
    window_ = PlayWindow(options_.from, options_.to);
    is_behind_ = false;
    do {
      while (is_going()) {
        const auto line = input_.next();
        if (!line) {
          break;
        }
        take_line(*line);
      }
      send_pending();
    } while (is_going() && input_.fill());
  }

  void take_line(std::string_view line) {
    if (pass_ == 0) {
      account_.next_line();
    }
    if (is_blank(line)) {
      return;
    }
    const auto parsed = parse_input_line(line, default_source);
    if (parsed && parsed->kind == InputLine::Kind::frame) {
      take_frame(*parsed);
    } else if (pass_ == 0 && parsed) {
      account_.pass_over(parsed->kind);
    } else if (pass_ == 0) {
      progress_.clear();
      account_.refuse(parsed.error());
    }
  }

  void take_frame(const InputLine& line) {
    const PlayWindow::Place place = window_.place(line.time);
    is_behind_ = place == PlayWindow::Place::behind;
    if (place != PlayWindow::Place::inside) {
      ++outside_;
      return;
    }
    const auto bus = bus_of(line.interface_name);
    if (!bus) {
      unwanted_ = unwanted_.empty() ? line.interface_name : unwanted_;
      ++unwanted_frames_;
      return;
    }
    untimed_ += line.time ? 0U : 1U;
    const auto due = schedule_.due(line.time, Clock::now());
    if (due > Clock::now() && (!send_pending() || !wait_until(due))) {
      return;
    }
    if (pending_.size() == batch_size || (!pending_.empty() && pending_bus_ != *bus)) {
      send_pending();
    }
    if (pending_.empty()) {
      pending_bus_ = *bus;
      pending_due_ = due;
    }
    pending_.push_back(line.frame);
  }

  [[nodiscard]] std::optional<std::size_t> bus_of(const std::string& interface_name) const {
    const auto found = options_.routes.bus_of.find(interface_name);
    return found != options_.routes.bus_of.end() ? std::optional(found->second)
                                                 : options_.routes.bus_of_all_others;
  }

  bool wait_until(Clock::time_point due) {
    for (;;) {
      const auto now = Clock::now();
      if (progress_.is_due(now)) {
        show_progress(now, due);
      }
      if (now >= due) {
        return true;
      }
      if (!Interrupt::sleep_until(std::min(due, progress_.next()))) {
        return false;
      }
    }
  }

  bool send_pending() {
    if (pending_.empty()) {
      return true;
    }
    const bool going = outputs_.send(pending_bus_, pending_);
    pending_.clear();
    const auto now = Clock::now();
    if (options_.pace.speed) {
      latest_ = std::max(latest_, now - pending_due_);
    }
    if (progress_.is_due(now)) {
      show_progress(now, now);
    }
    return going;
  }

  void show_progress(Clock::time_point now, Clock::time_point next) {
    std::string text = input_.name() + ": ";
    if (const auto share = input_.share()) {
      text += std::to_string(static_cast<int>(*share * 100)) + " %, ";
    }
    text += clock_text(now - start_) + ", " + count_of(outputs_.sent(), "frame");
    if (next - now > std::chrono::seconds(1)) {
      text += ", next in " + clock_text(next - now);
    }
    progress_.show(text, now);
  }

  int finish() {
    const int signal = Interrupt::signal();
    const std::uint64_t sent = outputs_.sent();
    note(input_.name() + ": " + count_of(sent, "frame") + " sent" + account_.text() +
         told_of_frames());
    if (signal != 0) {
      return exit_signal + signal;
    }
    return sent == 0 || account_.refused() > 0 ? exit_failure : exit_success;
  }

  [[nodiscard]] std::string told_of_frames() const {
    std::string text;
    if (outputs_.sent() == 0 && outside_ > 0) {
      text += ", all of it outside of --from and --to";
    }
    if (unwanted_frames_ > 0) {
      text += ", " + count_of(unwanted_frames_, "frame") + " of other interfaces passed over, " +
              quote(unwanted_) + " among them";
    }
    if (untimed_ > 0) {
      text += ", " + std::to_string(untimed_) + " without a time sent at once";
    }
    if (schedule_.steps_back() > 0) {
      text += ", the log's time went back " + count_of(schedule_.steps_back(), "time");
    }
    if (latest_ >= worth_a_word) {
      text += ", up to " +
              std::to_string(std::chrono::duration_cast<std::chrono::seconds>(latest_).count()) +
              " s late";
    }
    return text;
  }

  const PlayOptions& options_;
  LogInput input_;
  Outputs outputs_;
  LineAccount account_;
  Schedule schedule_;
  PlayWindow window_{std::nullopt, std::nullopt};
  bool is_behind_ = false;  // all that is to be played
  std::uint64_t pass_ = 0;
  std::vector<Frame> pending_;  // all due, and to one bus
  std::size_t pending_bus_ = 0;
  Clock::time_point pending_due_;
  std::string unwanted_;  // the first interface whose frames go nowhere
  std::uint64_t unwanted_frames_ = 0;
  std::uint64_t untimed_ = 0;
  std::uint64_t outside_ = 0;  // of --from and --to
  Clock::duration latest_{};
  Progress progress_;
  Clock::time_point start_ = Clock::now();
};

}  // namespace

int play(const PlayOptions& options) {
  try {
    return Player(options).run();
  } catch (const Interrupted&) {
    return exit_signal + Interrupt::signal();
  }
}

}  // namespace roio::cli
