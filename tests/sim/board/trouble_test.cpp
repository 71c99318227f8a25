// Programs that are none, and programs that come to an end (firmware/trouble.cpp).
#include <fstream>

#include "board_rig.hpp"

namespace roio::test {
namespace {

std::string refusal(sim::BoardKind kind, const std::filesystem::path& elf) {
  sim::CanBus bus;
  try {
    const sim::Board board(bus, kind, elf);
  } catch (const std::runtime_error& error) {
    std::string text = error.what();
    const std::string folder = elf.parent_path().string() + "/";
    const std::size_t at = text.find(folder);
    return at == std::string::npos ? text : text.erase(at, folder.size());
  }
  return "none";
}

std::filesystem::path file_of(const std::string& name, const std::string& content) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / name;
  std::ofstream(path, std::ios::binary) << content;
  return path;
}

TEST(BoardFile, IsRefusedWithItsReason) {
  using sim::BoardKind;
  EXPECT_EQ(refusal(BoardKind::uno, "/nowhere/x.elf"), "x.elf: no such file");
  EXPECT_EQ(refusal(BoardKind::uno, "/tmp"), "/tmp: is not a file");
  EXPECT_EQ(refusal(BoardKind::uno, file_of("empty.elf", "")), "empty.elf: is not an ELF file");
  EXPECT_EQ(refusal(BoardKind::uno, file_of("short.elf", "no\n")), "short.elf: is not an ELF file");
  EXPECT_EQ(refusal(BoardKind::uno, file_of("text.elf", std::string(100, 'x'))),
            "text.elf: is not an ELF file");
  EXPECT_EQ(refusal(BoardKind::uno, std::filesystem::canonical("/proc/self/exe")),
            "boards_test: is not a program for an AVR");
  EXPECT_EQ(refusal(BoardKind::uno, firmware("idle", "atmega32u4")),
            "idle.atmega32u4.elf: is for an atmega32u4, but a Uno has an atmega328p");
  EXPECT_EQ(refusal(BoardKind::leonardo, firmware("idle", "atmega2560")),
            "idle.atmega2560.elf: is for an atmega2560, but a Leonardo has an atmega32u4");
  const std::string too_big = refusal(BoardKind::uno, firmware("too_big", "atmega328p"));
  EXPECT_EQ(too_big.substr(0, 39), "too_big.atmega328p.elf: is too big: 331");
  EXPECT_NE(too_big.find(" bytes of flash, but a Uno has an atmega328p with 32768"),
            std::string::npos);
}

TEST(BoardFile, ThatIsCutShortIsRefused) {
  std::ifstream whole(firmware("idle", "atmega328p"), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(whole), std::istreambuf_iterator<char>()};
  for (const std::size_t length : {20U, 60U, 200U, 500U}) {
    EXPECT_EQ(refusal(sim::BoardKind::uno, file_of("cut.elf", bytes.substr(0, length))),
              "cut.elf: ends too early")
        << length;
  }
}

std::string beginning(const std::string& text, const std::string& as_long_as) {
  return text.substr(0, as_long_as.size());
}

class BoardTrouble : public EachBoard {
 protected:
  BoardTrouble() { bus_.run_for(1ms); }
  // What the run of the bus throws.
  std::string end_by(std::uint8_t command) {
    rig_.write({command});
    try {
      bus_.run_for(100ms);
    } catch (const sim::BoardError& error) {
      thrown_at_ = bus_.now();
      return error.what();
    }
    return "none";
  }
  BoardRig rig_{bus_, GetParam(), "trouble", {.name = "arm"}};
  sim::SimTime thrown_at_{0};
};
INSTANTIATE_TEST_SUITE_P(, BoardTrouble, all_boards, board_name);

TEST_P(BoardTrouble, NoInstruction) {
  EXPECT_EQ(beginning(end_by('i'), "arm crashed: CORE: *** "), "arm crashed: CORE: *** ");
  EXPECT_EQ(rig_.board.state(), sim::Board::State::crashed);
}

TEST_P(BoardTrouble, EmptyFlash) {
  EXPECT_EQ(beginning(end_by('f'), "arm crashed: the program has run into empty flash, at 0x"),
            "arm crashed: the program has run into empty flash, at 0x");
  EXPECT_EQ(rig_.board.state(), sim::Board::State::crashed);
}

TEST_P(BoardTrouble, NoMemoryThere) {
  EXPECT_EQ(beginning(end_by('m'), "arm crashed: CORE: *** Invalid write address"),
            "arm crashed: CORE: *** Invalid write address");
}

TEST_P(BoardTrouble, AsleepForEver) {
  EXPECT_EQ(beginning(end_by('s'), "arm halted: asleep with interrupts off, at 0x"),
            "arm halted: asleep with interrupts off, at 0x");
  EXPECT_EQ(rig_.board.state(), sim::Board::State::halted);
}

TEST_P(BoardTrouble, TheEndOfMain) {
  EXPECT_EQ(beginning(end_by('x'), "arm halted: in an empty loop with interrupts off, at 0x"),
            "arm halted: in an empty loop with interrupts off, at 0x");
  EXPECT_EQ(rig_.board.state(), sim::Board::State::halted);
}

// It is thrown when it happens, once; the bus goes on, and a reset gets the board out of it.
TEST_P(BoardTrouble, IsToldOnceAndAtItsTime) {
  const sim::SimTime begin = bus_.now();
  ASSERT_NE(end_by('i'), "none");
  EXPECT_GT(thrown_at_, begin + cpu_cycles(152));
  EXPECT_LT(thrown_at_, begin + cpu_cycles(152 + 60));
  EXPECT_EQ(thrown_at_, rig_.board.now());
  bus_.run_for(10ms);
  EXPECT_EQ(thrown_at_, rig_.board.now());
  rig_.board.reset();
  EXPECT_EQ(rig_.board.state(), sim::Board::State::running);
  EXPECT_EQ(rig_.board.trouble(), "");
  bus_.run_for(1ms);
  EXPECT_EQ(rig_.board.pin(13), false) << "it has begun again";
  EXPECT_GE(rig_.board.now(), bus_.now());
  EXPECT_LE(rig_.board.now(), bus_.now() + 2us);
  EXPECT_NE(end_by('i'), "none") << "and can be told again";
}

// The watchdog is no trouble, but a restart.
TEST_P(BoardTrouble, TheWatchdogResets) {
  EXPECT_EQ(end_by('w'), "none");
  EXPECT_GE(rig_.board.resets(), 1U);
}

}  // namespace
}  // namespace roio::test
