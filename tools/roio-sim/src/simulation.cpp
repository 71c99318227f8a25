#include "simulation.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <memory>
#include <roio/error.hpp>
#include <roio/text.hpp>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "board_words.hpp"
#include "bridge.hpp"
#include "form/input_line.hpp"
#include "form/record_format.hpp"
#include "interrupt.hpp"
#include "pace.hpp"
#include "panel.hpp"
#include "program/exit_status.hpp"
#include "report.hpp"

namespace roio::sim_tool {
namespace {

using Clock = Pace::Clock;
using namespace std::chrono_literals;

// Simulated at a time, and waited at a time: what a frame from outside, a signal or a command waits
// for at most.
constexpr sim::SimTime step = 1ms;
constexpr std::chrono::nanoseconds tick = 1ms;
constexpr Clock::duration between_complaints = 1s;
constexpr std::size_t most_lines_ahead = 64;
constexpr std::uint64_t most_refusals_told = 20;

// A bus that somebody else has opened before runs as it does; it works, but for holding up who
// sends too much.
std::unique_ptr<Bus> open_outside(const Options& options) {
  if (!options.bus) {
    return nullptr;
  }
  const auto url = parse_bus_url(*options.bus);
  constexpr double slowest = 1'000;
  constexpr double fastest = 1'000'000;
  const double bitrate = options.bitrate_bps * options.speed;
  if (!url || url->kind != BusUrl::Kind::local || url->bitrate || bitrate < slowest ||
      bitrate > fastest) {
    return open(*options.bus);
  }
  const std::string rate = std::to_string(std::lround(bitrate));
  try {
    return open(*options.bus + "?bitrate=" + rate);
  } catch (const std::system_error& error) {
    if (error.code() != Errc::bitrate_mismatch) {
      throw;
    }
  }
  note(*options.bus + ": was there before, and not at " + rate +
       " bit/s: it does not slow down who sends more than the simulated bus carries");
  return open(*options.bus);
}

// The commands of the command line and of standard input, in their order.
class Script {
 public:
  explicit Script(const std::vector<Instruction>& first) : due_(first.begin(), first.end()) {}

  /// To be polled for input; -1: no more to be read, or not now.
  [[nodiscard]] int fd() const {
    return at_end_ || due_.size() >= most_lines_ahead || is_background() ? -1 : STDIN_FILENO;
  }
  /// Only when there is something to read.
  void read() {
    at_end_ = !reader_.fill();
    while (const auto line = reader_.next()) {
      if (!cli::is_blank(*line)) {
        add(*line);
      }
    }
  }
  void end() { at_end_ = true; }

  [[nodiscard]] bool has_due(sim::SimTime now) const { return !due_.empty() && now >= resume_; }
  Instruction next() {
    Instruction instruction = std::move(due_.front());
    due_.pop_front();
    return instruction;
  }
  void wait_until(sim::SimTime time) { resume_ = time; }

  // A person sees each of his own. A script that has gone wrong is not to fill a disk.
  void refuse(const std::string& why) {
    if (++refused_ <= most_refusals_told || is_of_a_person()) {
      note(why);
    }
  }
  void finish() const {
    if (refused_ > most_refusals_told && !is_of_a_person()) {
      note("and " + cli::count_of(refused_ - most_refusals_told, "command") +
           " more that could not be done");
    }
  }
  /// A person at a terminal has seen it and gone on; a script has not.
  [[nodiscard]] bool has_failed() const { return refused_ > 0 && !is_of_a_person(); }

 private:
  static bool is_of_a_person() { return ::isatty(STDIN_FILENO) == 1; }
  // A program in the background that reads its terminal is stopped.
  static bool is_background() {
    const pid_t foreground = ::tcgetpgrp(STDIN_FILENO);
    return foreground != -1 && foreground != ::getpgrp();
  }
  void add(std::string_view line) {
    auto instruction = parse_instruction(line);
    if (instruction) {
      due_.push_back(*instruction);
    } else {
      refuse(quote(line) + ": " + instruction.error().message);
    }
  }

  std::deque<Instruction> due_;
  cli::LineReader reader_{STDIN_FILENO};
  bool at_end_ = false;
  std::uint64_t refused_ = 0;
  sim::SimTime resume_{0};
};

class Simulation {
 public:
  explicit Simulation(const Options& options)
      : options_(options),
        report_(options.json ? json_report() : text_report()),
        script_(options.instructions) {
    for (const BoardWish& wish : options.boards) {
      add_board(wish);
    }
    for (const Instruction& instruction : options.instructions) {
      check(instruction);
    }
    bridge_ = std::make_unique<Bridge>(bus_, options.bitrate_bps, open_outside(options));
  }

  int run() {
    if (options_.verbose) {
      note(options_.bus.value_or("no bus") + ": joined");
    }
    cli::flush(report_->out());
    Pace pace(options_.speed, Clock::now());
    try {
      while (!is_over()) {
        go_on(pace);
      }
    } catch (const sim::BoardError& error) {
      finish(pace);
      throw cli::Failure(error.what());
    } catch (const cli::Failure&) {
      finish(pace);
      throw;
    }
    finish(pace);
    if (const int signal = caught_signal()) {
      return cli::exit_signal + signal;
    }
    return script_.has_failed() ? cli::exit_failure : cli::exit_success;
  }

 private:
  void add_board(const BoardWish& wish) {
    try {
      panels_.push_back(std::make_unique<Panel>(bus_, wish, options_.bitrate_bps, *report_));
    } catch (const std::system_error& error) {
      if (wish.terminal_link.empty()) {
        throw;  // no terminal to be had
      }
      throw cli::UsageError(std::string("--serial-pty: ") + error.what());
    } catch (const std::runtime_error& error) {
      throw cli::UsageError(error.what());
    } catch (const std::invalid_argument& error) {
      throw cli::UsageError(wish.name + ": " + error.what());
    }
  }
  Panel& panel(const std::string& name) {
    const auto found = std::find_if(panels_.begin(), panels_.end(),
                                    [&](const auto& panel) { return panel->name() == name; });
    if (found == panels_.end()) {
      std::string names;
      for (const auto& panel : panels_) {
        names += (names.empty() ? "" : ", ") + panel->name();
      }
      throw std::invalid_argument("no board " + quote(name) + "; there is " + names);
    }
    return **found;
  }
  void check(const Instruction& instruction) {
    try {
      if (!instruction.board.empty()) {
        panel(instruction.board).check(instruction.action);
      }
    } catch (const std::invalid_argument& error) {
      throw cli::UsageError(std::string("--do: ") + error.what());
    }
  }

  [[nodiscard]] bool is_over() const {
    return quit_ || caught_signal() != 0 || (options_.end && bus_.now() >= *options_.end);
  }

  void go_on(Pace& pace) {
    const sim::SimTime due = pace.due(Clock::now(), bus_.now());
    obey();
    bridge_->take();
    const bool runs = due > bus_.now() && !bridge_->is_blocked() && !is_over();
    if (runs) {
      bus_.run_until(std::min({due, bus_.now() + step, options_.end.value_or(due)}));
      for (const auto& panel : panels_) {
        panel->look();
      }
    }
    bridge_->give(Clock::now());
    cli::flush(report_->out());
    complain(pace);
    const bool is_late = runs && due > bus_.now();
    listen(is_late || options_.speed == 0 ? 0ns : tick);
  }

  void listen(std::chrono::nanoseconds longest) {
    const bool ready = script_.has_due(bus_.now());
    std::array<pollfd, 2> fds{{{script_.fd(), POLLIN, 0}, {bridge_->fd(), POLLIN, 0}}};
    const timespec timeout{0, ready ? 0 : longest.count()};
    if (::ppoll(fds.data(), fds.size(), &timeout, nullptr) <= 0 || fds[0].revents == 0) {
      return;
    }
    try {
      script_.read();
    } catch (const cli::Failure& error) {
      note(error.what());  // closed, for example: it goes on without
      script_.end();
    }
  }

  void obey() {
    while (!quit_ && script_.has_due(bus_.now())) {
      const Instruction instruction = script_.next();
      if (const auto* const wait = std::get_if<Wait>(&instruction.action)) {
        script_.wait_until(bus_.now() + wait->time);
      } else if (const auto* const alone = std::get_if<Alone>(&instruction.action)) {
        bridge_->set_alone(alone->alone);
      } else if (std::holds_alternative<Quit>(instruction.action)) {
        quit_ = true;
      } else if (std::holds_alternative<Help>(instruction.action)) {
        note(std::string("commands:\n") + command_help);
      } else {
        obey(instruction);
      }
    }
  }
  void obey(const Instruction& instruction) {
    try {
      panel(instruction.board).apply(instruction.action);
    } catch (const std::invalid_argument& error) {
      script_.refuse(error.what());
    }
  }

  void complain(const Pace& pace) {
    const auto now = Clock::now();
    if (pace.behind() > complained_of_ && now - complained_ >= between_complaints) {
      complained_ = now;
      complained_of_ = pace.behind();
      note(fmt::format("cannot keep up: {:.1f} s behind real time", seconds_behind(pace)));
    }
  }
  static double seconds_behind(const Pace& pace) {
    if (pace.behind() == Clock::duration(0)) {
      return 0;
    }
    return std::chrono::duration<double>(pace.behind() + Pace::most_behind).count();
  }

  void finish(const Pace& pace) {
    for (const auto& panel : panels_) {
      panel->finish();
    }
    script_.finish();
    const sim::BusStatistics statistics = bus_.statistics();
    Summary summary;
    summary.time = bus_.now();
    summary.behind_s = seconds_behind(pace);
    summary.frames = statistics.frames;
    summary.errors = statistics.transmit_errors;
    summary.load = statistics.load();
    if (bridge_->outside() != nullptr) {
      summary.bus = bridge_->outside()->name();
      summary.from_bus = bridge_->taken();
      summary.to_bus = bridge_->given();
      summary.lost = bridge_->lost();
    }
    report_->summary(summary);
    cli::flush(report_->out());
  }

  const Options& options_;
  std::unique_ptr<Report> report_;
  Script script_;
  sim::CanBus bus_;
  std::vector<std::unique_ptr<Panel>> panels_;
  std::unique_ptr<Bridge> bridge_;
  bool quit_ = false;
  Clock::time_point complained_;
  Clock::duration complained_of_{0};
};

}  // namespace

int simulate(const Options& options) {
  return Simulation(options).run();
}

}  // namespace roio::sim_tool
