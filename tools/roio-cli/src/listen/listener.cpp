#include "listen/listener.hpp"

#include <algorithm>
#include <numeric>

#include "listen/filter_words.hpp"
#include "listen/intake.hpp"
#include "program/exit_status.hpp"
#include "program/interrupt.hpp"
#include "program/output.hpp"

namespace roio::cli {
namespace {

constexpr std::size_t most_at_once = 256;

// Longest wait at a time: how soon a change of the bus's state, or a reader that went away, is
// noticed when no frame comes.
constexpr Timeout look_around_every = std::chrono::milliseconds(200);

// After a signal, what has come is taken; where more keeps coming, for so long.
constexpr Timeout longest_drain = std::chrono::milliseconds(200);

}  // namespace

Listener::Listener(const ListenOptions& options)
    : options_(options), origins_(origins_of(options.buses)), ears_(options.buses.size()) {
  const auto filters = compile_filter_words(options.filters, options.no_foreign);
  if (!filters) {
    throw UsageError(filters.error().message);
  }
  OpenOptions open_options;
  open_options.send_only = true;  // nothing comes in before the filters are set
  open_options.error_frames = options.errors;
  for (const std::string& url : options.buses) {
    buses_.push_back(open_until_signal(url, open_options));
  }
  for (const auto& bus : buses_) {
    bus->set_filters(*filters);
  }
}

void Listener::run(Hearer& hearer) {
  for (std::size_t i = 0; i < buses_.size(); ++i) {
    ears_[i].watch.emplace(*buses_[i],
                           [&, i](const BusNews& news) { hearer.news(origins_[i], news); });
  }
  Intake intake(buses_);
  last_heard_ = Clock::now();
  // A signal ends it though frames keep coming: a bus gives what it has even when cancelled.
  while (!finished() && Interrupt::signal() == 0 && receive(intake, hearer)) {
    if (Clock::now() >= next_look_) {
      look();
    }
    hearer.settle(intake.heard().empty());
  }
  if (Interrupt::signal() != 0) {
    drain(intake, hearer);
  }
  for (Ear& ear : ears_) {
    ear.watch->tell_fd_frames();
  }
  hearer.settle(false);
}

std::uint64_t Listener::frames() const {
  return std::accumulate(ears_.begin(), ears_.end(), std::uint64_t{0},
                         [](std::uint64_t sum, const Ear& ear) { return sum + ear.frames; });
}

std::uint64_t Listener::lost(std::size_t bus) const {
  return std::max(buses_[bus]->statistics().dropped, ears_[bus].announced_lost);
}

std::uint64_t Listener::lost() const {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < buses_.size(); ++i) {
    sum += lost(i);
  }
  return sum;
}

std::uint64_t Listener::fd_frames(std::size_t bus) const {
  return ears_[bus].watch ? ears_[bus].watch->fd_frames() : 0;
}

int Listener::finish() const {
  if (const int signal = Interrupt::signal()) {
    return exit_signal + signal;
  }
  if (options_.count && !has_all()) {
    note(names_of(origins_) + ": " + std::to_string(frames()) + " of " +
         count_of(*options_.count, "frame") + " came in time");
    return exit_failure;
  }
  return exit_success;
}

Timeout Listener::quiet_time_left() const {
  return options_.quiet_time ? *options_.quiet_time - (Clock::now() - last_heard_) : forever;
}

// At most as many as are still to be shown: the others stay on the bus.
std::size_t Listener::room() const {
  return options_.count ? std::min<std::uint64_t>(*options_.count - frames(), most_at_once)
                        : most_at_once;
}

// @return false when a signal has ended it.
bool Listener::receive(Intake& intake, Hearer& hearer) {
  const std::size_t most = room();
  const Result result = intake.receive(most, std::min(quiet_time_left(), look_around_every));
  const bool heard = hear_all(intake, hearer);
  if (heard) {
    last_heard_ = Clock::now();
  }
  // A batch that was full is followed by the next at once.
  if (options_.gather > no_wait && heard && intake.heard().size() < most) {
    static_cast<void>(Interrupt::sleep_until(Clock::now() + options_.gather));
  }
  return result == Result::ok || result == Result::timeout;
}

// What came while frames gathered, and what was held back for its order.
void Listener::drain(Intake& intake, Hearer& hearer) {
  const auto until = Clock::now() + longest_drain;
  while (!has_all() && Clock::now() < until) {
    intake.take(room());
    if (intake.heard().empty()) {
      return;
    }
    hear_all(intake, hearer);
  }
}

// @return whether any was told.
bool Listener::hear_all(const Intake& intake, Hearer& hearer) {
  bool heard = false;
  for (const auto& [from, received] : intake.heard()) {
    heard = hear(from, *received, hearer) || heard;
  }
  return heard;
}

// @return whether it was told.
bool Listener::hear(std::size_t bus, const Received& received, Hearer& hearer) {
  Ear& ear = ears_[bus];
  if (received.lost_before > 0) {
    hearer.news(origins_[bus], {BusNews::Kind::lost, received.lost_before, {}});
    ear.announced_lost += received.lost_before;
  }
  const bool error = received.frame.kind == FrameKind::error;
  if (error) {
    next_look_ = {};  // the state that it tells of follows it at once
  }
  if (options_.no_foreign && !error && !is_roio(received.frame)) {
    return false;
  }
  hearer.frame(origins_[bus], received);
  ++ear.frames;
  return true;
}

void Listener::look() {
  next_look_ = Clock::now() + look_around_every;
  for (Ear& ear : ears_) {
    ear.watch->look();
  }
}

}  // namespace roio::cli
