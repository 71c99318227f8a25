#include "bus/wire_bits.hpp"

#include <gtest/gtest.h>

#include <roio/frame_length.hpp>
#include <string>

#include "vectors.hpp"
#include "wire_text.hpp"

namespace roio::sim {
namespace {

constexpr FrameKind standard = FrameKind::standard;
constexpr FrameKind standard_remote = FrameKind::standard_remote;
constexpr FrameKind extended = FrameKind::extended;
constexpr FrameKind extended_remote = FrameKind::extended_remote;

/// From the CRC delimiter to the end of the intermission.
constexpr int tail_bits = 13;

struct HandWorked {
  const char* why;
  Frame frame;
  std::string bits;     ///< Stuff bits in brackets.
  int arbitration_end;  ///< Where the RTR bit is, stuff bits counted.
};

const HandWorked hand_worked[] = {
    {"the frame of docs/protocol.md",
     {0x1000400A, extended, 3, {0x5A, 0x2D, 0x00}},
     "0 100000(1)00000(1) 11 000100000(1)00000(1)1010 000 0(1)011 01011010 00101101 00000(1)000 "
     "111011000010110",
     36},
    {"all zeros: the stuff bit that RTR completes comes after the arbitration field",
     {0x000, standard, 0, {}},
     "0 0000(1)00000(1)00 000(1) 0000 0(1)00000(1)00000(1)0000",
     14},
    {"remote: no data, though eight bytes are asked for",
     {0x7FF, standard_remote, 8, {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF}},
     "0 11111(0)11111(0)1 100 1000 0100000(1)11101101",
     14},
    {"DLC 15 carries 8 bytes",
     {0x00000000, extended, 15, {}},
     "0 0000(1)00000(1)00 11 00000(1)00000(1)00000(1)000 00(1)0 1111 00000(1)000 00(1)00000(1)0 "
     "0000(1)0000 0(1)00000(1)00 000(1)00000(1) 00000(1)000 00(1)00000(1)0 0000(1)0000 "
     "0(1)10100010101100",
     37},
    {"the longest: five equal bits end the CRC, and a stuff bit follows even those",
     {0x000C3C3C, extended, 8, {0x3C, 0x3C, 0x3F, 0xFF, 0x0F, 0x0F, 0x0F, 0x0F}},
     "0 0000(1)00000(1)11 11(0) 0000(1)1111(0)0000(1)1111(0)00 00(1)0 1000 00(1)1111(0)00 "
     "00(1)1111(0)00 00(1)1111(0)11 111(0)11111(0) 0000(1)1111(0) 0000(1)1111(0) 0000(1)1111(0) "
     "0000(1)1111(0) 0000(1)00000(1)011111(0)",
     39},
};

TEST(WireBits, HandWorkedFramesBitByBit) {
  for (const HandWorked& row : hand_worked) {
    EXPECT_EQ(test::wire_text(row.frame), test::digits_of(row.bits)) << row.why;
    EXPECT_EQ(wire_bits_of(row.frame).arbitration_end, row.arbitration_end) << row.why;
  }
}

TEST(WireBits, AreAsManyAsTheDocumentsWorkedExamplesSay) {
  for (const test::Vector& vector : test::read_vectors(ROIO_PROTOCOL_DOCUMENT)) {
    Frame frame{vector.id, extended, 0, {}};
    frame.length = vector.message.length;
    std::copy_n(vector.message.data, frame.length, frame.data);
    EXPECT_EQ(wire_bits_of(frame).size + tail_bits, vector.bits) << vector;
  }
}

TEST(WireBits, AreAsManyAsTheFrameLengthOfAnyFrame) {
  std::mt19937 generator = test::seeded_generator();
  for (int i = 0; i < 20'000; ++i) {
    const Frame frame = test::random_frame(generator);
    ASSERT_EQ(wire_bits_of(frame).size + tail_bits, wire_bits(frame)) << test::text_of(frame);
  }
}

TEST(WireBits, OfARemoteExtendedFrame) {
  // RTR is recessive, and no data follow the DLC.
  const std::string bits = test::wire_text({0x15555555, extended_remote, 8, {}});
  EXPECT_EQ(bits.substr(0, 39),
            "010101010101"
            "11"
            "010101010101010101"
            "1"
            "00"
            "1000");
  EXPECT_EQ(static_cast<int>(bits.size()) + tail_bits,
            wire_bits({0x15555555, extended_remote, 8, {}}));
}

}  // namespace
}  // namespace roio::sim
