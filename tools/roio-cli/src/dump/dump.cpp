#include "dump/dump.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <roio/text.hpp>
#include <span>

#include "dump/filter_words.hpp"
#include "form/record_format.hpp"
#include "program/exit_status.hpp"
#include "program/interrupt.hpp"
#include "program/output.hpp"

namespace roio::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t batch_size = 256;

// Longest wait at a time: how soon a change of the bus's state, or a reader that went away, is
// noticed when no frame comes.
constexpr Timeout look_around_every = std::chrono::milliseconds(200);

// A local bus without a hub for longer than this is worth a word.
constexpr Timeout hub_change_time = std::chrono::seconds(2);

// The log's own names: an interface's is at most 15 bytes long, and a local bus's goes without
// "local:".
std::string name_in_log(const std::string& bus_url) {
  constexpr std::size_t longest = 15;
  const auto url = parse_bus_url(bus_url);
  return (url ? url->target : bus_url).substr(0, longest);
}

std::unique_ptr<RecordFormat> make_format(const DumpOptions& options) {
  switch (options.form) {
    case DumpOptions::Form::log:
      return log_format(name_in_log(options.bus));
    case DumpOptions::Form::json:
      return json_format(nullptr);
    case DumpOptions::Form::text:
      break;
  }
  return text_format(options.time, wants_colour());
}

class Dump {
 public:
  Dump(const DumpOptions& options, Bus& bus)
      : options_(options),
        bus_(bus),
        format_(make_format(options)),
        batch_(batch_size),
        is_local_(bus.name().starts_with("local:")) {}

  int run() {
    last_shown_ = Clock::now();
    // A signal ends it though frames keep coming: a bus gives what it has even when cancelled.
    while (!finished() && Interrupt::signal() == 0 && receive()) {
      if (Clock::now() >= next_look_) {
        announce_changes();
      }
      flush(out_);
    }
    tell_fd_frames();
    flush(out_);
    return say_last_word();
  }

 private:
  [[nodiscard]] bool has_all() const { return options_.count && shown_ >= *options_.count; }
  [[nodiscard]] Timeout quiet_time_left() const {
    return options_.quiet_time ? *options_.quiet_time - (Clock::now() - last_shown_) : forever;
  }
  [[nodiscard]] bool finished() const { return has_all() || quiet_time_left() <= no_wait; }

  // At most as many as are still to be shown: the others stay on the bus.
  std::span<Received> room() {
    const std::uint64_t wanted = options_.count ? *options_.count - shown_ : batch_size;
    return std::span(batch_).first(std::min<std::uint64_t>(wanted, batch_size));
  }

  // @return false when the end has come: a signal, or nobody reads on.
  bool receive() {
    const Transfer transfer = bus_.receive(room(), std::min(quiet_time_left(), look_around_every));
    const std::uint64_t shown_before = shown_;
    for (const Received& received : std::span(batch_).first(transfer.count)) {
      show(received);
    }
    if (shown_ != shown_before) {
      last_shown_ = Clock::now();
    }
    if (transfer.result == Result::timeout && output_is_gone()) {
      throw BrokenPipe{};
    }
    return transfer.result == Result::ok || transfer.result == Result::timeout;
  }

  void show(const Received& received) {
    if (received.lost_before > 0) {
      format_->lost(out_, received.lost_before);
      announced_lost_ += received.lost_before;
    }
    const bool error = received.frame.kind == FrameKind::error;
    if (error) {
      next_look_ = {};  // the state that it tells of follows it at once
    }
    if (options_.no_foreign && !error && !is_roio(received.frame)) {
      return;
    }
    format_->frame(out_, received);
    ++shown_;
  }

  // Asks the kernel, so not after every batch.
  void announce_changes() {
    next_look_ = Clock::now() + look_around_every;
    if (told_fd_frames_ == 0) {
      tell_fd_frames();
    }
    const BusState state = bus_.state();
    if (is_local_ && is_between_hubs(state)) {
      return;
    }
    const std::uint64_t outages = bus_.statistics().outages;
    const bool is_out = state == BusState::down || state == BusState::absent;
    // An outage that began and ended between two looks.
    if (outages != outages_ && !is_out && !is_local_) {
      announce(BusState::down);
    }
    announce(state);
    outages_ = outages;
  }

  // The first as soon as they come, so that nobody waits for a dump of what it cannot show; the
  // others at the end.
  void tell_fd_frames() {
    const std::uint64_t seen = bus_.statistics().fd_frames;
    if (seen > told_fd_frames_) {
      format_->not_shown(out_, seen - told_fd_frames_);
      told_fd_frames_ = seen;
    }
  }

  // On a local bus another process becomes the hub within moments, and nothing is lost by it.
  bool is_between_hubs(BusState state) {
    if (state != BusState::absent) {
      last_present_ = Clock::now();
      return false;
    }
    return Clock::now() - last_present_ < hub_change_time;
  }

  void announce(BusState state) {
    if (state != state_) {
      format_->state(out_, state);
      state_ = state;
    }
  }

  int say_last_word() {
    const std::uint64_t lost = std::max(bus_.statistics().dropped, announced_lost_);
    if (lost > 0 || told_fd_frames_ > 0 || options_.verbose) {
      note(bus_.name() + ": " + count_of(shown_, "frame") + " shown, " + std::to_string(lost) +
           " lost" + (told_fd_frames_ > 0 ? ", " + fd_frames_not_shown(told_fd_frames_) : ""));
    }
    if (const int signal = Interrupt::signal()) {
      return exit_signal + signal;
    }
    if (options_.count && !has_all()) {
      note(bus_.name() + ": " + std::to_string(shown_) + " of " +
           count_of(*options_.count, "frame") + " came in time");
      return exit_failure;
    }
    return exit_success;
  }

  const DumpOptions& options_;
  Bus& bus_;
  std::unique_ptr<RecordFormat> format_;
  std::vector<Received> batch_;
  Buffer out_;
  BusState state_ = BusState::active;
  bool is_local_;
  std::uint64_t outages_ = 0;
  Clock::time_point last_present_ = Clock::now();
  Clock::time_point next_look_;  // at once: the bus may be down from the start
  std::uint64_t shown_ = 0;
  std::uint64_t announced_lost_ = 0;
  std::uint64_t told_fd_frames_ = 0;
  Clock::time_point last_shown_;
};

}  // namespace

int dump(const DumpOptions& options) {
  const auto filters = compile_filter_words(options.filters, options.no_foreign);
  if (!filters) {
    throw UsageError(filters.error().message);
  }
  OpenOptions open_options;
  open_options.send_only = true;  // nothing comes in before the filters are set
  open_options.error_frames = options.errors;
  const auto bus = open_until_signal(options.bus, open_options);
  bus->set_filters(*filters);
  const CancelOnSignal cancel_on_signal(*bus);
  if (options.verbose) {
    note(bus->name() + ": listening");
  }
  return Dump(options, *bus).run();
}

}  // namespace roio::cli
