// Sketches for the library of 2014, as they were written then: one prints what it gets and answers,
// one does what a letter on its serial port asks for.
#include "sketch_rig.hpp"

namespace roio::test {
namespace {

TEST(Classic2014, PrintsWhoSentWhatAndAnswers) {
  SketchRig rig(sim::BoardKind::uno, "Classic2014");
  rig.bus.run_for(500ms);
  rig.send({0, 2}, {7, 200});
  rig.bus.run_for(300ms);
  EXPECT_EQ(rig.lines, Texts{"0.10 7 200"});
  EXPECT_EQ(rig.received, (Texts{"0.2 > 0.10: 07", "0.2 > 0.10: 07 C8", "0.2 > 10.25: 2D",
                                 "0.2 > 10.25: 72 6F 69 6F 00 01 02 03", "0.2 > 0.*: 07",
                                 "0.2 > 10.*: 01", "0.2 > 0.*: 72 6F 69 6F 00 01 02 03"}));
}

TEST(Classic2014, KnowsABroadcast) {
  SketchRig rig(sim::BoardKind::uno, "Classic2014");
  rig.bus.run_for(500ms);
  rig.pc.send(frame_of({31, 254}, {0, broadcast_node}, {1}));
  rig.bus.run_for(300ms);
  EXPECT_EQ(rig.lines, Texts{"31.254 to all 1"});
}

// --- its calls, one by one -----------------------------------------------------------------------

using ChipMode = sim::Mcp2515Chip::OperationMode;
constexpr Address node{0, 2};

class Calls2014 : public testing::Test {
 protected:
  Calls2014() { rig.bus.run_for(100ms); }

  /// What it prints, of each before the next.
  Texts call(const std::string& letters) {
    Texts printed;
    for (const char letter : letters) {
      const Texts lines = call_at_once(std::string(1, letter));
      printed.insert(printed.end(), lines.begin(), lines.end());
    }
    return printed;
  }
  Texts call_at_once(const std::string& letters) {
    const std::vector<std::uint8_t> bytes(letters.begin(), letters.end());
    rig.board.serial_write(0, bytes);
    return rig.run_for_lines(50ms);
  }
  void send(Address source, const Bytes& data) {
    rig.pc.send(frame_of(source, node, data));
    rig.bus.run_for(1ms);
  }
  [[nodiscard]] ChipMode mode() { return rig.board.chip().mode(); }

  SketchRig rig{sim::BoardKind::uno, "Calls2014"};
};

TEST_F(Calls2014, StatusIsTheByteThatReadStatusWas) {
  EXPECT_EQ(call("s"), Texts{"0"}) << "nothing sent yet";
  EXPECT_EQ(call("xs"), Texts{"8"}) << "one sent, and idle: TX0IF";
  EXPECT_EQ(call("xs"), Texts{"8"}) << "which stays";
  send({0, 10}, {1});
  EXPECT_EQ(call("s"), Texts{"9"}) << "RX0IF";
  send({0, 10}, {2});
  EXPECT_EQ(call("s"), Texts{"B"}) << "and RX1IF";
  EXPECT_EQ(call("rs"), (Texts{"1 0.10 1", "9"}));
  EXPECT_EQ(call("rs"), (Texts{"2 0.10 2", "8"}));
  rig.pc.controller().set_mode(sim::Controller::Mode::off);
  EXPECT_EQ(call("xs"), Texts{"C"}) << "TXREQ: nobody acknowledges";
  EXPECT_EQ(call("zs"), Texts{"0"}) << "reset";
}

TEST_F(Calls2014, StatusOfTheFirstThatIsStillToBeSent) {
  rig.pc.controller().set_mode(sim::Controller::Mode::off);
  EXPECT_EQ(call("xs"), Texts{"4"});
  rig.pc.controller().set_mode(sim::Controller::Mode::normal);
  rig.bus.run_for(10ms);
  EXPECT_EQ(call("s"), Texts{"8"});
}

TEST_F(Calls2014, AvailableIsHowManyCanBeRead) {
  EXPECT_EQ(call("a"), Texts{"0"});
  send({0, 10}, {1});
  EXPECT_EQ(call("aa"), Texts(2, "1"));
  send({0, 11}, {2});
  EXPECT_EQ(call("a"), Texts{"2"});
  send({0, 12}, {3});
  EXPECT_EQ(call("a"), Texts{"2"}) << "no more than that: the third is in the chip";
  EXPECT_EQ(call("rarara"), (Texts{"1 0.10 1", "2", "2 0.11 2", "1", "3 0.12 3", "0"}));
}

// Not a message of Roio's for a sketch: the chip has it, and read() would not.
TEST_F(Calls2014, AvailableCountsNothingThatReadDoesNotGive) {
  Frame system = frame_of({0, 10}, node, {1});
  system.id |= 1U << 26;
  rig.pc.send(system);
  EXPECT_EQ(call("as"), (Texts{"0", "0"}));
}

TEST_F(Calls2014, ReadOfNothingLeavesWhatWasReadLast) {
  send({3, 10}, {7, 8});
  EXPECT_EQ(call("r"), Texts{"7 3.10 7 8"});
  EXPECT_EQ(call("r"), Texts{"0 3.10 7 8"});
}

TEST_F(Calls2014, WriteOfReadAnswersWhoeverAsked) {
  for (std::uint8_t asker = 10; asker < 14; ++asker) {
    send({static_cast<std::uint8_t>(asker - 10), asker}, {asker});
    call(asker < 13 ? "e" : "b");
  }
  EXPECT_EQ(rig.received,
            (Texts{"0.2 > 0.10: 0A", "0.2 > 1.11: 0B", "0.2 > 2.12: 0C", "0.2 > 3.*: 0D"}));
}

TEST_F(Calls2014, WriteCutsALengthAboveEight) {
  call("w");
  EXPECT_EQ(rig.received, Texts{"0.2 > 0.10: 00 01 02 03 04 05 06 07"});
}

TEST_F(Calls2014, BeginTakesRatesByThreshold) {
  for (const std::uint32_t bps : {1'000'000U, 1'000'000U, 500'000U, 500'000U, 250'000U, 250'000U,
                                  125'000U, 125'000U, 10'000U, 10'000U, 10'000U, 10'000U}) {
    call("k");
    EXPECT_EQ(rig.board.chip().bitrate_bps(), bps);
    EXPECT_EQ(mode(), ChipMode::normal);
  }
}

TEST_F(Calls2014, ChangeModeReachesEachAndComesBack) {
  const struct {
    const char* letter;
    ChipMode mode;
  } rows[] = {{"2", ChipMode::sleep},
              {"4", ChipMode::loopback},
              {"6", ChipMode::listen_only},
              {"8", ChipMode::configuration}};
  for (const auto& row : rows) {
    SCOPED_TRACE(row.letter);
    call(row.letter);
    EXPECT_EQ(mode(), row.mode);
    call("9");
    EXPECT_EQ(mode(), row.mode) << "A0h is none";
    call("0");
    EXPECT_EQ(mode(), ChipMode::normal);
    send({0, 10}, {1});
    EXPECT_EQ(call("r"), Texts{"1 0.10 1"}) << "with address and rate as before";
  }
}

TEST_F(Calls2014, WhatWasWrittenGoesOutBeforeItSleeps) {
  call_at_once("xx2");
  EXPECT_EQ(rig.received, Texts(2, "0.2 > 0.10: 01"));
  EXPECT_EQ(mode(), ChipMode::sleep);
}

TEST_F(Calls2014, StatusesHaveTheWordsOfTheCore) {
  Texts words;
  for (std::uint8_t i = 0; i < 11; ++i) {
    words.emplace_back(to_string(static_cast<Status>(i)));
  }
  EXPECT_EQ(call("t"), words);
}

TEST_F(Calls2014, BufferPinsShowFullBuffersWhenAsked) {
  const auto pin = [this](int buffer) { return rig.board.chip().receive_buffer_pin(buffer); };
  EXPECT_EQ(pin(0), std::nullopt);
  call("L");
  EXPECT_EQ(pin(0), true);
  send({0, 10}, {1});
  send({0, 10}, {2});
  rig.bus.run_for(10ms);
  EXPECT_EQ(pin(0), false);
  EXPECT_EQ(pin(1), false);
  call("rr");
  EXPECT_EQ(pin(0), true);
  EXPECT_EQ(pin(1), true);
}

}  // namespace
}  // namespace roio::test
