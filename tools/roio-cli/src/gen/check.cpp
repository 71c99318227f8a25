#include "gen/check.hpp"

#include <algorithm>
#include <roio/bus.hpp>
#include <roio/message.hpp>
#include <vector>

#include "form/record_format.hpp"
#include "gen/checker.hpp"
#include "program/exit_status.hpp"
#include "program/interrupt.hpp"
#include "program/output.hpp"

namespace roio::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t batch_size = 256;

class Check {
 public:
  Check(const CheckOptions& options, Bus& bus)
      : options_(options), bus_(bus), batch_(batch_size), start_(Clock::now()), last_(start_) {}

  void run() {
    while (!has_all() && time_left() > no_wait && receive()) {
    }
  }

  /// @return the exit status.
  int report() {
    Buffer out;
    for (const Checker::Report& report : checker_.reports()) {
      append(out, to_string(report));
    }
    const SequenceCounts total = checker_.total();
    if (checker_.reports().size() > 1) {
      append(out, fmt::format("all: {} received, {} lost, {} doubled, {} out of order",
                              total.received, total.lost, total.doubled, total.out_of_order));
    }
    flush(out);
    tell_others();
    return status(total);
  }

 private:
  [[nodiscard]] bool has_all() const { return options_.count && received_ >= *options_.count; }

  [[nodiscard]] Timeout time_left() const {
    const Clock::time_point now = Clock::now();
    Timeout left = forever;
    if (options_.time) {
      left = std::min<Timeout>(left, start_ + *options_.time - now);
    }
    if (options_.quiet_time) {
      left = std::min<Timeout>(left, last_ + *options_.quiet_time - now);
    }
    return left;
  }

  // @return false when a signal came.
  bool receive() {
    const Transfer transfer = bus_.receive(batch_, time_left());
    const std::uint64_t received_before = received_;
    for (const Received& received : std::span(batch_).first(transfer.count)) {
      take(received.frame);
    }
    if (received_ != received_before) {
      last_ = Clock::now();
    }
    return Interrupt::signal() == 0 &&
           (transfer.result == Result::ok || transfer.result == Result::timeout);
  }

  void take(const Frame& frame) {
    Message message{};
    if (has_all() || to_message(frame, message) != Status::ok) {
      return;
    }
    received_ += checker_.add(message) ? 1U : 0U;
  }

  static void append(Buffer& out, const std::string& line) {
    out.append(line.data(), line.data() + line.size());
    out.push_back('\n');
  }

  void tell_others() const {
    if (checker_.others() > 0) {
      note(bus_.name() + ": " + count_of(checker_.others(), "other message") + " passed over");
    }
    if (const std::uint64_t lost = bus_.statistics().dropped; lost > 0) {
      note(bus_.name() + ": " + count_of(lost, "frame") +
           " lost on the way to this program, among all");
    }
  }

  [[nodiscard]] int status(const SequenceCounts& total) const {
    if (total.received == 0) {
      note(bus_.name() + ": no numbered message came");
    } else if (options_.count && !has_all()) {
      note(bus_.name() + ": " + std::to_string(total.received) + " of " +
           count_of(*options_.count, "message") + " came in time");
    }
    const bool too_few = total.received == 0 || (options_.count && !has_all());
    if (checker_.failed()) {
      return exit_failure;
    }
    if (const int signal = Interrupt::signal()) {
      return exit_signal + signal;
    }
    return too_few ? exit_failure : exit_success;
  }

  const CheckOptions& options_;
  Bus& bus_;
  std::vector<Received> batch_;
  Checker checker_;
  std::uint64_t received_ = 0;
  Clock::time_point start_;
  Clock::time_point last_;
};

}  // namespace

int check(const CheckOptions& options) {
  const auto bus = open_until_signal(options.bus);
  const CancelOnSignal cancel_on_signal(*bus);
  if (options.verbose) {
    note(bus->name() + ": listening");
  }
  Check check(options, *bus);
  check.run();
  return check.report();
}

}  // namespace roio::cli
