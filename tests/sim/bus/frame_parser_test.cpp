#include "bus/frame_parser.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "wire_text.hpp"

namespace roio::sim {
namespace {

using Step = FrameParser::Step;

/// What the parser makes of bits, up to the first answer that is not "more".
Step parse(FrameParser& parser, const std::string& bits, std::size_t* taken = nullptr) {
  parser.start();
  Step step = Step::more;
  std::size_t i = 0;
  while (step == Step::more && i < bits.size()) {
    step = parser.put(bits[i++] == '0' ? 0 : 1);
  }
  if (taken != nullptr) {
    *taken = i;
  }
  return step;
}

TEST(FrameParser, ReadsBackEveryFrame) {
  std::mt19937 generator = test::seeded_generator();
  FrameParser parser;  // one for all: nothing of a frame must be left in the next
  for (int i = 0; i < 20'000; ++i) {
    const Frame frame = test::random_frame(generator);
    const std::string bits = test::wire_text(frame);
    std::size_t taken = 0;
    ASSERT_EQ(parse(parser, bits, &taken), Step::complete) << test::text_of(frame);
    ASSERT_EQ(taken, bits.size()) << test::text_of(frame);
    ASSERT_TRUE(parser.crc_matches()) << test::text_of(frame);
    ASSERT_EQ(test::text_of(parser.frame()), test::text_of(frame));
    ASSERT_EQ(parser.frame().kind, frame.kind);
  }
}

TEST(FrameParser, DataPastTheLengthAreZero) {
  FrameParser parser;
  parse(parser, test::wire_text({0x123, FrameKind::standard, 8, {1, 2, 3, 4, 5, 6, 7, 8}}));
  parse(parser, test::wire_text({0x123, FrameKind::standard, 2, {9, 9}}));
  const std::uint8_t expected[8] = {9, 9};
  EXPECT_EQ(std::memcmp(parser.frame().data, expected, sizeof expected), 0);
}

TEST(FrameParser, TheSixthEqualBitIsAnError) {
  FrameParser parser;
  std::size_t taken = 0;
  EXPECT_EQ(parse(parser, "000000", &taken), Step::stuff_error);
  EXPECT_EQ(taken, 6U);
  EXPECT_EQ(parse(parser, "0111111", &taken), Step::stuff_error);
  EXPECT_EQ(taken, 7U);
  // A stuff bit is the first of the next five.
  EXPECT_EQ(parse(parser, "00000111110", &taken), Step::more);
  EXPECT_EQ(parse(parser, "00000111111", &taken), Step::stuff_error);
  EXPECT_EQ(taken, 11U);
}

TEST(FrameParser, TellsBeforehandWhereAStuffBitComes) {
  FrameParser parser;
  parse(parser, "0000");
  EXPECT_FALSE(parser.expects_stuff_bit());
  parse(parser, "00000");
  EXPECT_TRUE(parser.expects_stuff_bit());
  parse(parser, "000001");
  EXPECT_FALSE(parser.expects_stuff_bit());
  parse(parser, "000001111");
  EXPECT_FALSE(parser.expects_stuff_bit());
  parse(parser, "0000011111");
  EXPECT_TRUE(parser.expects_stuff_bit());
}

TEST(FrameParser, FiveEqualBitsThatEndTheCrcAreFollowedByAStuffBit) {
  const Frame longest{
      0x000C3C3C, FrameKind::extended, 8, {0x3C, 0x3C, 0x3F, 0xFF, 0x0F, 0x0F, 0x0F, 0x0F}};
  const std::string bits = test::wire_text(longest);
  FrameParser parser;
  EXPECT_EQ(parse(parser, bits.substr(0, bits.size() - 1)), Step::more);
  EXPECT_EQ(parse(parser, bits), Step::complete);
  EXPECT_EQ(parse(parser, bits.substr(0, bits.size() - 1) + "1"), Step::stuff_error);
}

TEST(FrameParser, AFlippedBitNeverMakesAnotherFrame) {
  const Frame frames[] = {{0x1000400A, FrameKind::extended, 3, {0x5A, 0x2D, 0x00}},
                          {0x555, FrameKind::standard, 1, {0xAA}},
                          {0x7FF, FrameKind::standard_remote, 8, {}}};
  FrameParser parser;
  for (const Frame& frame : frames) {
    const std::string bits = test::wire_text(frame);
    for (std::size_t i = 1; i < bits.size(); ++i) {
      std::string flipped = bits;
      flipped[i] = flipped[i] == '0' ? '1' : '0';
      // What follows a frame is recessive.
      const Step step = parse(parser, flipped + std::string(100, '1'));
      EXPECT_FALSE(step == Step::complete && parser.crc_matches())
          << test::text_of(frame) << ", bit " << i;
    }
  }
}

}  // namespace
}  // namespace roio::sim
