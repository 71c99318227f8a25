#include "top/top.hpp"

#include <signal.h>

#include <algorithm>
#include <array>
#include <memory>
#include <roio/bus.hpp>

#include "form/record_format.hpp"
#include "names/robot_labels.hpp"
#include "program/exit_status.hpp"
#include "program/interrupt.hpp"
#include "program/output.hpp"
#include "top/keys.hpp"
#include "top/lines.hpp"
#include "top/terminal.hpp"
#include "top/traffic_watch.hpp"
#include "top/view.hpp"

namespace roio::cli {
namespace {

using Clock = std::chrono::steady_clock;

// Frames are taken so much later than they could be, and so many at a time.
constexpr Clock::duration gather_time = std::chrono::milliseconds(2);

constexpr std::chrono::milliseconds screen_interval{250};
constexpr std::chrono::milliseconds lines_interval{1000};

/// Who looks at it: a terminal, or a pipe.
class Face {
 public:
  Face() = default;
  Face(const Face&) = delete;
  Face& operator=(const Face&) = delete;
  virtual ~Face() = default;

  [[nodiscard]] virtual std::chrono::milliseconds interval() const = 0;
  /// Or after the first interval.
  [[nodiscard]] virtual bool begins_at_once() const = 0;
  virtual void show(TrafficWatch& watch) = 0;
  /// What to wait for besides frames, and what to do then.
  [[nodiscard]] virtual pollfd input() const = 0;
  [[nodiscard]] virtual pollfd output() const = 0;
  virtual void look(const pollfd& input, const pollfd& output, TrafficWatch& watch) = 0;
  /// The exit status, once it has ended.
  [[nodiscard]] virtual std::optional<int> end() const = 0;
};

class Lines final : public Face {
 public:
  explicit Lines(const Robot* robot) : robot_(robot) {}

  [[nodiscard]] std::chrono::milliseconds interval() const override { return lines_interval; }
  [[nodiscard]] bool begins_at_once() const override { return false; }
  void show(TrafficWatch& watch) override {
    append_json(out_, watch.snapshot(), robot_);
    flush(out_);
  }
  [[nodiscard]] pollfd input() const override { return {-1, 0, 0}; }
  [[nodiscard]] pollfd output() const override { return {1, 0, 0}; }
  void look(const pollfd& /*input*/, const pollfd& output, TrafficWatch& /*watch*/) override {
    if ((output.revents & POLLERR) != 0) {
      throw BrokenPipe{};
    }
  }
  [[nodiscard]] std::optional<int> end() const override { return std::nullopt; }

 private:
  const Robot* robot_;
  Buffer out_;
};

class Screen final : public Face {
 public:
  explicit Screen(const Labels& labels) : labels_(labels) {}

  [[nodiscard]] std::chrono::milliseconds interval() const override { return screen_interval; }
  [[nodiscard]] bool begins_at_once() const override { return true; }

  void show(TrafficWatch& watch) override {
    Snapshot now = watch.snapshot();
    if (!view_.paused) {
      snapshot_ = std::move(now);
    } else {
      snapshot_.state = now.state;  // that is told, whatever stands still
    }
    draw_now();
  }

  [[nodiscard]] pollfd input() const override { return terminal_.input(); }
  [[nodiscard]] pollfd output() const override { return terminal_.output(); }

  void look(const pollfd& input, const pollfd& output, TrafficWatch& watch) override {
    constexpr int lost = POLLERR | POLLHUP | POLLNVAL;
    if ((output.revents & lost) != 0 || terminal_.gone()) {
      end_ = exit_signal + SIGHUP;
      return;
    }
    if ((output.revents & POLLOUT) != 0) {
      terminal_.write_on();
    }
    if (input.revents != 0) {
      take_keys(watch);
    }
    if (terminal_.changed()) {
      draw_now();
    }
  }

  [[nodiscard]] std::optional<int> end() const override { return end_; }

 private:
  void draw_now() {
    terminal_.show(draw(snapshot_, view_, labels_, Terminal::size(), colour_));
    terminal_.write_on();
  }

  void take_keys(TrafficWatch& watch) {
    const auto bytes = Terminal::read();
    if (!bytes) {
      end_ = exit_signal + SIGHUP;
      return;
    }
    for (const Action action : keys_.feed(*bytes)) {
      view_ = after(view_, action, snapshot_.rows.size(), Terminal::size());
      if (action == Action::quit) {
        end_ = exit_success;
        return;
      }
      if (action == Action::clear) {
        watch.clear();
        view_.paused = false;
        show(watch);
      }
    }
    draw_now();
  }

  const Labels& labels_;
  Terminal terminal_;
  KeyReader keys_;
  View view_;
  Snapshot snapshot_;
  bool colour_ = wants_colour();
  std::optional<int> end_;
};

std::unique_ptr<Face> make_face(const TopOptions& options, const Labels& labels) {
  if (options.json || !output_is_terminal()) {
    return std::make_unique<Lines>(options.robot.get());
  }
  return std::make_unique<Screen>(labels);
}

class Top {
 public:
  Top(const TopOptions& options, Bus& bus)
      : options_(options),
        bus_(bus),
        labels_(labels_of(options.robot)),
        watch_(bus, options.bus, options.bitrate_bps, *labels_),
        face_(make_face(options, *labels_)),
        interval_(options.interval.value_or(face_->interval())) {}

  /// @return the exit status.
  int run() {
    next_ = Clock::now() + (face_->begins_at_once() ? Clock::duration(0) : interval_);
    while (!face_->end() && !has_shown_all()) {
      const TrafficWatch::Taken taken = watch_.take();
      if (taken == TrafficWatch::Taken::closed) {
        break;
      }
      show_if_due();
      if (!wait(taken == TrafficWatch::Taken::some)) {
        return exit_signal + Interrupt::signal();
      }
    }
    return face_->end().value_or(exit_success);
  }

 private:
  [[nodiscard]] bool has_shown_all() const { return options_.count && shown_ >= *options_.count; }

  void show_if_due() {
    const Clock::time_point now = Clock::now();
    if (now >= next_) {
      face_->show(watch_);
      ++shown_;
      next_ = std::max(next_ + interval_, now);
    }
  }

  // @return false when a signal came.
  bool wait(bool gather) {
    std::array<pollfd, 3> fds{
        {{gather ? -1 : bus_.fd(), POLLIN, 0}, face_->input(), face_->output()}};
    const Clock::time_point until = gather ? std::min(next_, Clock::now() + gather_time) : next_;
    const bool going = Interrupt::wait(fds, has_shown_all() ? Clock::time_point() : until);
    if (going) {
      face_->look(fds[1], fds[2], watch_);
    }
    return going;
  }

  const TopOptions& options_;
  Bus& bus_;
  std::shared_ptr<const Labels> labels_;
  TrafficWatch watch_;
  std::unique_ptr<Face> face_;
  Clock::duration interval_;
  Clock::time_point next_;
  std::uint64_t shown_ = 0;
};

}  // namespace

int top(const TopOptions& options) {
  const auto bus = open_until_signal(options.bus);
  const CancelOnSignal cancel_on_signal(*bus);
  const int status = Top(options, *bus).run();
  if (const std::uint64_t lost = bus->statistics().dropped; lost > 0) {
    note(bus->name() + ": " + count_of(lost, "frame") + " lost");
  }
  return status;
}

}  // namespace roio::cli
