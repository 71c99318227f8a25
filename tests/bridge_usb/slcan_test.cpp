// The bridge's image as an adapter that speaks SLCAN.
#include "bridge_rig.hpp"

namespace roio::test {
namespace {

class Slcan : public testing::Test {
 protected:
  /// @return what is answered, with BEL as '!' and CR as '.'.
  std::string ask(std::string_view commands, sim::SimTime wait = 30ms) {
    rig.text.clear();
    rig.write({commands.begin(), commands.end()});
    rig.bus.run_for(wait);
    std::string answer;
    for (const std::uint8_t byte : rig.text) {
      answer += byte == '\a' ? '!' : byte == '\r' ? '.' : static_cast<char>(byte);
    }
    return answer;
  }
  /// What a node at this rate hears of a frame; an answer shows that it was taken.
  bool is_heard_at(std::uint32_t rate_bps) {
    sim::HostNode other(rig.bus, rate_bps);
    rig.set_peer(false);
    bool heard = false;
    other.on_receive([&](const Frame& /*frame*/) { heard = true; });
    EXPECT_EQ(ask("t1230\r"), "z.");
    other.controller().set_mode(sim::Controller::Mode::off);
    return heard;
  }

  BridgeRig rig;
};

TEST_F(Slcan, AfterARateThatIsRefusedNothingOpens) {
  for (const char* refused : {"SA\r", "S66\r", "S\r", "s\r", "s000\r", "s0000\r", "s0100\r"}) {
    EXPECT_EQ(ask("C\r"), ".");
    EXPECT_EQ(ask("S6\r"), ".");
    EXPECT_EQ(ask(refused), "!") << refused;
    EXPECT_EQ(ask("O\r"), "!") << refused;
    EXPECT_EQ(ask("L\r"), "!") << refused;
    EXPECT_EQ(ask("t1230\r"), "!") << "closed";
    EXPECT_EQ(ask("S6\rO\r"), "..") << "until one is accepted";
  }
}

TEST_F(Slcan, ARateWhileOpenIsRefusedAndNotForgotten) {
  ASSERT_EQ(ask("C\rS6\rO\r"), "...");
  EXPECT_EQ(ask("S4\r"), "!");
  EXPECT_EQ(ask("t1230\r"), "z.") << "as it was";
  EXPECT_EQ(ask("C\rO\r"), ".!");
}

TEST_F(Slcan, S9Is83333) {
  ASSERT_EQ(ask("C\rS9\rO\r"), "...");
  EXPECT_TRUE(is_heard_at(83'333));
}

TEST_F(Slcan, RegistersOfAnSja1000AreMapped) {
  struct Case {
    const char* why;
    const char* command;
    std::uint32_t rate_bps;
  };
  const Case cases[] = {
      {"4 x 16", "s031C\r", 125'000},
      {"6 x 16, LAWICEL's own way to 83.3 kbit/s", "s051C\r", 83'333},
      {"1 x 10 quanta of an SJA1000, sampled at 80 %", "s0016\r", 800'000},
  };
  for (const Case& one : cases) {
    ASSERT_EQ(ask("C\r" + std::string(one.command) + "O\r"), "...") << one.why;
    EXPECT_TRUE(is_heard_at(one.rate_bps)) << one.why;
  }
}

TEST_F(Slcan, AClosedChannelIsInNoWrongState) {
  EXPECT_EQ(ask("C\rF\r"), ".F00.");
  EXPECT_EQ(ask("S6\rO\rF\r"), "..F00.");
}

TEST_F(Slcan, WhatNobodyAcknowledgesIsGivenUpAndFSaysSoOnce) {
  ASSERT_EQ(ask("C\rS6\rO\rF\r"), "...F00.");
  rig.set_peer(false);
  EXPECT_EQ(ask("t1230\r"), "z.");
  rig.bus.run_for(1s);
  EXPECT_EQ(ask("F\r"), "F22.");
  EXPECT_EQ(ask("F\r"), "F20.");
  rig.on_bus.clear();
  rig.set_peer(true);
  rig.bus.run_for(1s);
  EXPECT_TRUE(rig.on_bus.empty());
  EXPECT_EQ(ask("t4560\r"), "z.");
  EXPECT_EQ(rig.on_bus.size(), 1U);
}

TEST_F(Slcan, NoMoreWaitThanAreRemembered) {
  ASSERT_EQ(ask("C\rS6\rO\r"), "...");
  rig.set_peer(false);
  std::string answers;
  for (int i = 0; i < 20; ++i) {
    answers += ask("t1230\r", 5ms);
  }
  EXPECT_EQ(answers, "z.z.z.z.z.z.z.z.z.z.z.z.z.z.z.z.!!!!");
}

TEST_F(Slcan, WhateverEndsItNothingOldIsSentLater) {
  struct Case {
    const char* name;
    const char* commands;
  };
  const Case cases[] = {
      {"closed", "C\r"},
      {"and opened again", "C\rO\r"},
      {"and listening", "C\rL\r"},
      {"at another rate and back", "C\rS4\rO\rC\rS6\rO\r"},
  };
  for (const Case& one : cases) {
    ask("C\rS6\rO\r");
    rig.set_peer(false);
    for (int i = 0; i < 6; ++i) {
      ASSERT_EQ(ask("T1000400A15A\r", 5ms), "Z.");
    }
    ask(one.commands);
    rig.on_bus.clear();
    rig.set_peer(true);
    rig.bus.run_for(800ms);
    EXPECT_TRUE(rig.on_bus.empty()) << one.name;
  }
}

TEST_F(Slcan, ASessionOfRoiosProtocolTakesNothingOver) {
  ASSERT_EQ(ask("C\rS6\rO\r"), "...");
  rig.set_peer(false);
  for (int i = 0; i < 6; ++i) {
    ASSERT_EQ(ask("T1000400A15A\r", 5ms), "Z.");
  }
  rig.write({0});  // as a PC does: what was on the line before is over
  rig.hello();
  ASSERT_FALSE(rig.hello().empty()) << "once more: the first WELCOME comes after text";
  rig.on_bus.clear();
  rig.set_peer(true);
  rig.poll_for(300ms);
  EXPECT_TRUE(rig.on_bus.empty());
}

}  // namespace
}  // namespace roio::test
