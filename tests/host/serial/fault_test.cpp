// A line with errors, both ways at once: nothing wrong, nothing twice, and every loss counted.
#include <algorithm>

#include "line.hpp"

namespace roio::test {
namespace {

/// Changes, drops and makes up bytes; a made-up one takes the place of the next.
class Faults {
 public:
  Faults(std::uint32_t seed, double probability) : random_(seed), probability_(probability) {}
  std::optional<std::uint8_t> operator()(std::uint8_t byte) {
    if (std::uniform_real_distribution<>(0, 1)(random_) >= probability_) {
      return byte;
    }
    const auto kind = random_();
    if (kind % 3 == 0) {
      return std::nullopt;
    }
    return kind % 3 == 1 ? static_cast<std::uint8_t>(byte ^ (1U << (random_() % 8)))
                         : static_cast<std::uint8_t>(random_());
  }

 private:
  std::mt19937 random_;
  double probability_;
};

struct Traffic {
  std::uint32_t up = 0;
  std::uint32_t down = 0;
};

/// Frames both ways, as fast as they go, for so long; then peace, until all is settled.
Traffic run_traffic(Line& line, Time span) {
  Traffic traffic;
  line.at_each_step = [&, next = line.now]() mutable {
    if (line.now >= next && line.bridge.out.size() < 200) {
      line.bridge.hear(numbered(traffic.up++), line.now);
    } else if (line.now >= next) {
      line.bridge.hear(numbered(traffic.up++), line.now, false);
    }
    next = line.now >= next ? next + 400us : next;
    if (line.session.waiting() < 8) {
      const std::vector<Frame> frame{numbered(traffic.down)};
      traffic.down += static_cast<std::uint32_t>(line.session.offer(frame, line.now));
    }
  };
  line.run_for(span);
  line.at_each_step = nullptr;
  line.up_fault = nullptr;
  line.down_fault = nullptr;
  EXPECT_TRUE(line.run_until(
      [&] { return line.session.phase() == Phase::ready && line.session.all_done(); }, 5s));
  line.run_for(300ms);
  return traffic;
}

void expect_all_accounted(const Line& line, const Traffic& traffic) {
  std::uint64_t next = 0;
  for (const auto& one : line.arrived) {
    ASSERT_GE(number_of(one.frame), next) << "out of order, or twice, or wrong";
    next = number_of(one.frame) + 1;
  }
  EXPECT_EQ(line.arrived.size() + line.session.lost(), traffic.up);
  std::uint64_t told = 0;
  for (const auto& one : line.arrived) {
    told += one.lost_before;
  }
  EXPECT_LE(told, line.session.lost());

  std::uint64_t next_on_bus = 0;
  for (const Frame& frame : line.bridge.on_bus) {
    ASSERT_GE(number_of(frame), next_on_bus) << "out of order, or twice, or wrong";
    next_on_bus = number_of(frame) + 1;
  }
  const serial::DownFrames::Counters& down = line.session.down();
  EXPECT_EQ(down.sent + down.unknown + down.not_sent + down.dropped, traffic.down);
  EXPECT_GE(line.bridge.on_bus.size(), down.sent);
  EXPECT_LE(line.bridge.on_bus.size(), down.sent + down.unknown);
}

struct FaultCase {
  const char* why;
  double probability;
  bool up;
  bool down;
};

TEST(SerialFaults, AreAllAccountedFor) {
  const FaultCase cases[] = {
      {"none", 0, false, false},         {"up, rare", 1e-4, true, false},
      {"down, rare", 1e-4, false, true}, {"both, now and then", 1e-3, true, true},
      {"both, often", 5e-3, true, true}, {"both, a very bad line", 2e-2, true, true},
  };
  for (const FaultCase& row : cases) {
    for (std::uint32_t seed = 1; seed <= 3; ++seed) {
      SCOPED_TRACE(std::string(row.why) + ", seed " + std::to_string(seed));
      Line line;
      line.open();
      if (row.up) {
        line.up_fault = Faults(seed, row.probability);
      }
      if (row.down) {
        line.down_fault = Faults(seed + 100, row.probability);
      }
      const Traffic traffic = run_traffic(line, 3s);
      EXPECT_GT(traffic.up, 5'000U);
      EXPECT_GT(traffic.down, 10U);
      expect_all_accounted(line, traffic);
    }
  }
}

TEST(SerialFaults, WithoutThemNothingIsLostOrSentTwice) {
  Line line;
  line.open();
  const Traffic traffic = run_traffic(line, 2s);
  EXPECT_EQ(line.session.down().sent, traffic.down);
  EXPECT_EQ(line.session.down().resent, 0U);
  EXPECT_EQ(line.session.counters().damaged, 0U);
  EXPECT_EQ(line.session.counters().sessions, 1U);
}

}  // namespace
}  // namespace roio::test
