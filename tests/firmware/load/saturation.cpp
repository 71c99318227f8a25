#include "saturation.hpp"

#include "rig.hpp"

namespace roio::load {
namespace {

constexpr int counting_pin = 3;
constexpr int printing_pin = 4;
constexpr Address own{10, 85};  // bits that alternate: hardly ever stuffed, so the frames are short
constexpr double work_cycles = 160;
constexpr double cpu_hz = 16e6;

/// Source and data tell the number, as the sketch expects it.
Frame numbered(std::uint64_t number, int length) {
  const Address source{static_cast<std::uint8_t>(number / 255 % 32),
                       static_cast<std::uint8_t>(number % 255)};
  return frame_of(source, own,
                  Bytes(static_cast<std::size_t>(length), static_cast<std::uint8_t>(number)));
}

class Load {
 public:
  Load(const SaturationCase& load)
      : pc_(bus_, load.bitrate_bps),
        board_(bus_, sim::BoardKind::uno, image(load.image), options_of(load)),
        printed_(board_, 0),
        length_(load.length) {
    board_.set_pin(counting_pin, true);
    board_.set_pin(printing_pin, true);
    pc_.on_sent([this](const Frame&) {
      ++sent_;
      if (sending_) {
        give();
      }
    });
    bus_.run_for(start_up);
  }

  SaturationReport run(sim::SimTime span, bool sends) {
    board_.set_pin(counting_pin, false);
    bus_.run_for(200us);
    const sim::BusStatistics before = bus_.statistics();
    sending_ = sends;
    if (sends) {
      give();
      give();  // the next one waits always
    }
    bus_.run_for(span);
    const sim::BusStatistics after = bus_.statistics();
    sending_ = false;
    board_.set_pin(counting_pin, true);
    bus_.run_for(20ms);
    board_.set_pin(printing_pin, false);
    bus_.run_for(100ms);

    SaturationReport report;
    report.bus_load = (after.busy - before.busy) / std::chrono::duration<double, std::pico>(span);
    report.frame_us = us(span) / static_cast<double>(after.frames - before.frames);
    report.sent = sent_;
    report.accepted = board_.chip().events().accepted;
    report.overflowed = board_.chip().events().overflowed;
    const std::vector<std::uint64_t> numbers = printed_.numbers();
    if (numbers.size() != 9 || !board_.violations().empty() ||
        !board_.chip().violations().empty()) {
      throw std::runtime_error("the sketch did not print its figures, or misused its hardware");
    }
    report.received = numbers[0];
    report.disordered = numbers[1];
    report.wrong = numbers[2];
    report.left_over = static_cast<double>(numbers[3]) * work_cycles / (seconds(span) * cpu_hz);
    report.counted_received = numbers[4];
    report.counted_overflows = numbers[6];
    report.chip_losses = numbers[7];
    report.line_losses = numbers[8];
    return report;
  }

 private:
  static sim::BoardOptions options_of(const SaturationCase& load) {
    sim::BoardOptions options;
    options.chip.osc_hz = load.osc_hz;
    return options;
  }
  void give() { pc_.send(numbered(next_++, length_)); }

  sim::CanBus bus_;
  sim::HostNode pc_;
  sim::Board board_;
  Printed printed_;
  int length_;
  bool sending_ = false;
  std::uint64_t next_ = 0;
  std::uint64_t sent_ = 0;
};

}  // namespace

SaturationReport saturate(const SaturationCase& load, sim::SimTime span) {
  return Load(load).run(span, true);
}

double left_over_when_idle(const SaturationCase& load, sim::SimTime span) {
  return Load(load).run(span, false).left_over;
}

}  // namespace roio::load
