#include "call_time.hpp"

#include <algorithm>
#include <optional>

#include "rig.hpp"

namespace roio::load {
namespace {

constexpr int holding_pin = 3;

int cpu_cycles(sim::SimTime span) {
  return static_cast<int>((span.count() * 16 + 500'000) / 1'000'000);
}

/// The pulses of two pins: one as long as the call runs, and one when it gave what was wanted.
class Calls {
 public:
  /// @param failed null: calls that did not are not counted.
  Calls(sim::Board& board, int call_pin, int ok_pin, CallTimes& ok, CallTimes* failed)
      : ok_(ok), failed_(failed) {
    board.on_pin(call_pin, [this](sim::SimTime time, bool high) {
      if (high) {
        count_failed();
        from_ = time;
      } else if (from_) {
        last_ = cpu_cycles(time - *from_);
      }
    });
    board.on_pin(ok_pin, [this](sim::SimTime, bool high) {
      if (high && last_) {
        ++ok_[*last_];
        last_.reset();
      }
    });
  }

 private:
  void count_failed() {
    if (last_ && failed_ != nullptr) {
      ++(*failed_)[*last_];
    }
    last_.reset();
  }

  CallTimes& ok_;
  CallTimes* failed_;
  std::optional<sim::SimTime> from_;
  std::optional<int> last_;
};

CallTimes without(const CallTimes& times, int bracket) {
  CallTimes result;
  for (const auto& [cycles, calls] : times) {
    result[cycles - bracket] += calls;
  }
  return result;
}

}  // namespace

int usual(const CallTimes& times) {
  const auto most = std::max_element(times.begin(), times.end(), [](const auto& a, const auto& b) {
    return a.second <= b.second && a != b;
  });
  return most == times.end() ? 0 : most->first;
}
int shortest(const CallTimes& times) {
  return times.empty() ? 0 : times.begin()->first;
}
int longest(const CallTimes& times) {
  return times.empty() ? 0 : times.rbegin()->first;
}

CallTimeReport measure_calls(const std::string& image_name, int length, int messages,
                             bool in_pairs) {
  sim::CanBus bus;
  sim::HostNode pc(bus, echo_bps);
  sim::Board board(bus, sim::BoardKind::uno, image(image_name));
  CallTimeReport report;
  board.set_pin(holding_pin, true);
  {
    // The first pulse of pin 4 has nothing in it.
    std::optional<sim::SimTime> from;
    board.on_pin(4, [&](sim::SimTime time, bool high) {
      if (high && !from) {
        from = time;
      } else if (from && report.bracket == 0) {
        report.bracket = cpu_cycles(time - *from);
      }
    });
    while (report.bracket == 0 && bus.now() < 1s) {
      bus.run_for(10us);
    }
  }
  const Calls receiving(board, 4, 5, report.receive, &report.nothing);
  const Calls sending(board, 6, 7, report.send, nullptr);
  pc.on_receive([&](const Frame&) { ++report.bus_frames; });
  bus.run_for(1ms);
  const Frame frame =
      frame_of(pc_address, echo_address, Bytes(static_cast<std::size_t>(length), 0x5A));
  for (int i = 0; i < messages; ++i) {
    // The chip holds two.
    board.set_pin(holding_pin, !in_pairs);
    pc.send(frame);
    if (in_pairs) {
      pc.send(frame);
      bus.run_for(1ms);
      board.set_pin(holding_pin, true);
    }
    bus.run_for(2ms + i % 101 * 619ns);
  }
  report.receive = without(report.receive, report.bracket);
  report.nothing = without(report.nothing, report.bracket);
  report.send = without(report.send, report.bracket);
  return report;
}

}  // namespace roio::load
