#include "gen/gen.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <roio/bus.hpp>
#include <roio/frame_length.hpp>
#include <roio/text.hpp>
#include <span>
#include <vector>

#include "form/record_format.hpp"
#include "gen/pace.hpp"
#include "program/bitrate.hpp"
#include "program/exit_status.hpp"
#include "program/interrupt.hpp"
#include "program/output.hpp"
#include "send/outcome.hpp"
#include "send/sender.hpp"

namespace roio::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t batch_size = 64;

class Generation {
 public:
  Generation(const GenOptions& options, Bus& bus)
      : options_(options),
        bus_(bus),
        sender_(bus, options.timeout),
        bitrate_(BitrateSource(bus, options.bus, options.bitrate_bps).bps()),
        traffic_(options.traffic),
        start_(Clock::now()) {
    if (options.load) {
      pace_.emplace(*options.load * bitrate_or_refuse(), start_);
    } else if (options.rate) {
      pace_.emplace(static_cast<double>(*options.rate), start_);
    }
  }

  /// Until count, time, or a signal. @throws Failure: a message had to wait longer than the
  /// timeout.
  void run() {
    while (!has_all() && !is_over() && wait_for_turn() && send(due())) {
    }
  }

  /// Tells what was sent, and closes the bus. @throws Failure: some of it was not.
  void end() {
    wait_for_outcomes(bus_);  // the time that they took counts
    note(report());
    sender_.close();
  }

 private:
  [[nodiscard]] std::string report() const {
    const double s = std::max(std::chrono::duration<double>(Clock::now() - start_).count(), 1e-6);
    const TrafficOptions& traffic = options_.traffic;
    std::string text = fmt::format("{}: {} sent as {} #{} in {:.3f} s, {:.0f}/s", bus_.name(),
                                   count_of(sender_.sent(), "message"),
                                   traffic.source ? to_string(*traffic.source) : "any", traffic.id,
                                   s, static_cast<double>(sender_.sent()) / s);
    if (bitrate_) {
      constexpr double percent = 100;
      text += fmt::format(", load {:.1f} %", bits_ / s / *bitrate_ * percent);
    }
    return text;
  }

  [[nodiscard]] std::uint32_t bitrate_or_refuse() const {
    if (!bitrate_) {
      throw UsageError("--load: the bit rate of " + bus_.name() +
                       " is not known; expected --bitrate BPS");
    }
    return *bitrate_;
  }

  [[nodiscard]] bool has_all() const { return options_.count && sender_.sent() >= *options_.count; }
  [[nodiscard]] bool is_over() const {
    return options_.time && Clock::now() >= start_ + *options_.time;
  }

  // @return false when a signal came.
  bool wait_for_turn() const {
    if (!pace_) {
      return Interrupt::signal() == 0;
    }
    const auto end = options_.time ? start_ + *options_.time : Clock::time_point::max();
    return Interrupt::sleep_until(std::min(pace_->next(), end));
  }

  std::span<const Frame> due() {
    const std::uint64_t left = options_.count ? *options_.count - sender_.sent() : batch_size;
    const Clock::time_point now = Clock::now();
    batch_.clear();
    while (batch_.size() < std::min<std::uint64_t>(left, batch_size) &&
           (!pace_ || pace_->next() <= now)) {
      batch_.push_back(traffic_.next());
      if (pace_) {
        pace_->spend(options_.load ? wire_bits(batch_.back()) : 1.0, now);
      }
    }
    return batch_;
  }

  // @return false when a signal came first.
  bool send(std::span<const Frame> frames) {
    const std::uint64_t sent_before = sender_.sent();
    const bool going = sender_.send(frames);
    for (const Frame& frame : frames.first(sender_.sent() - sent_before)) {
      bits_ += wire_bits(frame);
    }
    return going;
  }

  const GenOptions& options_;
  Bus& bus_;
  Sender sender_;
  std::optional<std::uint32_t> bitrate_;
  Traffic traffic_;
  Clock::time_point start_;
  std::optional<Pace> pace_;
  std::vector<Frame> batch_;
  double bits_ = 0;
};

}  // namespace

int gen(const GenOptions& options) {
  OpenOptions open_options;
  open_options.send_only = true;
  open_options.lifetime = options.timeout;
  const auto bus = open_until_signal(options.bus, open_options);
  const CancelOnSignal cancel_on_signal(*bus);
  Generation generation(options, *bus);
  if (options.traffic.is_random()) {
    note(bus->name() + ": seed " + std::to_string(options.traffic.seed));
  }
  generation.run();
  generation.end();
  return Interrupt::signal() != 0 ? exit_signal + Interrupt::signal() : exit_success;
}

}  // namespace roio::cli
