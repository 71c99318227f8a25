#include "bit_errors.hpp"

#include <algorithm>

#include "rig.hpp"

namespace roio::load {
namespace {

constexpr int printing_pin = 3;
constexpr std::size_t most_under_way = 3;  // Echo can hold four

Frame numbered(std::uint32_t number) {
  Bytes data(8);
  for (unsigned i = 0; i < 4; ++i) {
    data[i] = static_cast<std::uint8_t>(number >> (8 * i));
    data[4 + i] = static_cast<std::uint8_t>(~data[i]);
  }
  return frame_of(pc_address, echo_address, data);
}

Frame answer_to(std::uint32_t number) {
  Frame frame = numbered(number);
  frame.id = frame_of(echo_address, pc_address, {}).id;
  return frame;
}

bool same(const Frame& a, const Frame& b) {
  return a.id == b.id && a.kind == b.kind && a.length == b.length &&
         std::equal(a.data, a.data + a.length, b.data);
}

/// The frames that come in at one end, which ought to have rising numbers.
class Arrivals {
 public:
  explicit Arrivals(Frame (*expected)(std::uint32_t)) : expected_(expected) {}

  void take(const Frame& frame) {
    std::uint32_t number = 0;
    for (unsigned i = 0; i < 4; ++i) {
      number |= std::uint32_t{frame.data[i]} << (8 * i);
    }
    ++all;
    if (!same(frame, expected_(number))) {
      ++corrupted;
    } else if (number < next_) {
      ++(number + 1 == next_ ? repeated : disordered);
    } else {
      skipped += number - next_;
      next_ = number + 1;
    }
  }

  std::uint64_t all = 0;
  std::uint64_t corrupted = 0;
  std::uint64_t repeated = 0;
  std::uint64_t disordered = 0;
  std::uint64_t skipped = 0;
  [[nodiscard]] std::uint32_t next() const { return next_; }

 private:
  Frame (*expected_)(std::uint32_t);
  std::uint32_t next_ = 0;
};

class Exchange {
 public:
  Exchange()
      : pc_(bus_, echo_bps),
        board_(bus_, sim::BoardKind::uno, image("EchoCounts")),
        printed_(board_, 0) {
    board_.set_pin(printing_pin, true);
    pc_.on_sent([this](const Frame&) { ++sent_; });
    pc_.on_receive([this](const Frame& frame) {
      back_.take(frame);
      last_back_ = bus_.now();
      under_way_ -= under_way_ > 0 ? 1 : 0;
    });
    board_.chip().on_accepted([this](const Frame& frame) { there_.take(frame); });
    bus_.run_for(start_up);
  }

  BitErrorReport run(double probability, std::uint32_t seed, sim::SimTime span) {
    bus_.set_bit_errors(probability, seed);
    send_for(span);
    bus_.set_bit_errors(0, 0);
    // Bus-off ends within 3 ms, and then all goes well.
    bus_.run_for(200ms);
    BitErrorReport report;
    const std::uint64_t sent = sent_;
    const Arrivals back = back_;
    under_way_ = 0;
    while (sent_ < sent + 100 && bus_.now() < span + 10s) {
      send_for(1ms);
    }
    bus_.run_for(20ms);
    report.alive = sent_ - sent >= 100 && back_.all - back.all == sent_ - sent &&
                   back_.skipped == back.skipped && back_.next() == given_;
    fill(report);
    return report;
  }

 private:
  /// One is given to the bus when there is room for it in Echo, as far as is known; what was lost
  /// is noticed by and by.
  void send_for(sim::SimTime span) {
    const sim::SimTime end = bus_.now() + span;
    while (bus_.now() < end) {
      if (bus_.now() - last_back_ > 50ms) {
        under_way_ = pc_.waiting();
        last_back_ = bus_.now();
      }
      while (under_way_ < most_under_way && pc_.waiting() < 2) {
        pc_.send(numbered(given_++));
        ++under_way_;
      }
      check_bus_off();
      bus_.run_for(200us);
    }
  }

  void check_bus_off() {
    const bool off = pc_.controller().confinement() == sim::Confinement::bus_off;
    pc_bus_offs_ += off && !pc_was_off_ ? 1 : 0;
    pc_was_off_ = off;
  }

  void fill(BitErrorReport& report) {
    const sim::Mcp2515Events& events = board_.chip().events();
    report.sent = sent_;
    report.accepted = events.accepted;
    report.repeated = there_.repeated;
    report.overflowed = events.overflowed;
    report.missing = there_.skipped;
    report.corrupted = there_.corrupted;
    report.chip_sent = events.sent;
    report.back = back_.all;
    report.back_repeated = back_.repeated;
    report.back_missing = back_.skipped - std::min(back_.skipped, there_.skipped);
    report.back_corrupted = back_.corrupted;
    report.disordered = there_.disordered + back_.disordered;
    report.flipped_bits = bus_.statistics().flipped_bits;
    report.transmit_errors = bus_.statistics().transmit_errors;
    report.chip_bus_offs = events.bus_offs;
    report.pc_bus_offs = pc_bus_offs_;

    board_.set_pin(printing_pin, false);
    bus_.run_for(50ms);
    const std::vector<std::uint64_t> numbers = printed_.numbers();
    if (numbers.size() != 8 || !board_.violations().empty() ||
        !board_.chip().violations().empty()) {
      throw std::runtime_error("Echo did not print its counters, or misused its hardware");
    }
    const auto number = [&](std::size_t at) { return static_cast<std::uint16_t>(numbers[at]); };
    report.echo_received = number(0);
    report.echo_foreign = number(1);
    report.echo_overflows = number(2);
    report.echo_sent = number(3);
    report.echo_unknown = number(4);
    report.echo_chip_losses = number(5);
    report.echo_keeps = static_cast<std::uint16_t>(number(6) + number(7));
  }

  sim::CanBus bus_;
  sim::HostNode pc_;
  sim::Board board_;
  Printed printed_;
  Arrivals there_{numbered};
  Arrivals back_{answer_to};
  std::uint32_t given_ = 0;
  std::uint64_t sent_ = 0;
  std::size_t under_way_ = 0;
  sim::SimTime last_back_{0};
  std::uint64_t pc_bus_offs_ = 0;
  bool pc_was_off_ = false;
};

}  // namespace

BitErrorReport echo_under_bit_errors(double probability, std::uint32_t seed, sim::SimTime span) {
  return Exchange().run(probability, seed, span);
}

}  // namespace roio::load
