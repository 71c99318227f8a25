#include <gtest/gtest.h>

#include <algorithm>
#include <bitset>
#include <roio/frame_length.hpp>
#include <string>

#include "seed.hpp"

namespace roio {
namespace {

constexpr FrameKind standard = FrameKind::standard;
constexpr FrameKind standard_remote = FrameKind::standard_remote;
constexpr FrameKind extended = FrameKind::extended;
constexpr FrameKind extended_remote = FrameKind::extended_remote;

/// From the CRC delimiter to the end of the intermission.
constexpr std::size_t tail_bits = 13;

struct HandWorked {
  const char* why;
  Frame frame;
  /// From start-of-frame to the CRC, field by field, stuff bits in brackets.
  std::string bits;
  std::uint16_t crc;
};

std::size_t digits(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return c == '0' || c == '1'; }));
}

const HandWorked hand_worked[] = {
    {"all zeros, the CRC too: a stuff bit after every five",
     {0x000, standard, 0, {}},
     "0 0000(1)00000(1)00 000(1) 0000 0(1)00000(1)00000(1)0000",
     0x0000},
    {"runs across fields and within the CRC",
     {0x555, standard, 1, {0xAA}},
     "0 10101010101 000 00(1)01 10101010 111100000(1)000010",
     0x7802},
    {"no run of five at all",
     {0x1D5, standard, 4, {0x9A, 0x55, 0x55, 0x55}},
     "0 00111010101 000 0100 10011010 01010101 01010101 01010101 000010000100001",
     0x0421},
    {"remote: no data, though eight bytes are asked for",
     {0x7FF, standard_remote, 8, {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF}},
     "0 11111(0)11111(0)1 100 1000 0100000(1)11101101",
     0x20ED},
    {"all ones",
     {0x7FF, standard, 8, {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF}},
     "0 11111(0)11111(0)1 000 1000 11111(0)111 11(0)11111(0)1 1111(0)1111 1(0)11111(0)11 "
     "111(0)11111(0) 11111(0)111 11(0)11111(0)1 1111(0)1111 1(0)00110010001001",
     0x4C89},
    {"the frame of docs/protocol.md",
     {0x1000400A, extended, 3, {0x5A, 0x2D, 0x00}},
     "0 100000(1)00000(1) 11 000100000(1)00000(1)1010 000 0(1)011 01011010 00101101 00000(1)000 "
     "111011000010110",
     0x7616},
    {"extended remote: three recessive bits more",
     {0x1FFFFFFF, extended_remote, 0, {}},
     "0 11111(0)11111(0)1 11 11(0)11111(0)11111(0)11111(0)1 100 000(1)0 110111101001101",
     0x6F4D},
    {"a DLC of 15 is eight bytes, and 15 goes into the CRC",
     {0x00000000, extended, 15, {}},
     "0 0000(1)00000(1)00 11 00000(1)00000(1)00000(1)000 00(1)0 1111 00000(1)000 00(1)00000(1)0 "
     "0000(1)0000 0(1)00000(1)00 000(1)00000(1) 00000(1)000 00(1)00000(1)0 0000(1)0000 "
     "0(1)10100010101100",
     0x28AC},
    {"the longest: five equal bits end the CRC, and a stuff bit follows even those",
     {0x000C3C3C, extended, 8, {0x3C, 0x3C, 0x3F, 0xFF, 0x0F, 0x0F, 0x0F, 0x0F}},
     "0 0000(1)00000(1)11 11(0) 0000(1)1111(0)0000(1)1111(0)00 00(1)0 1000 00(1)1111(0)00 "
     "00(1)1111(0)00 00(1)1111(0)11 111(0)11111(0) 0000(1)1111(0) 0000(1)1111(0) 0000(1)1111(0) "
     "0000(1)1111(0) 0000(1)00000(1)011111(0)",
     0x001F},
};

TEST(FrameLength, HandWorkedFrames) {
  for (const HandWorked& row : hand_worked) {
    SCOPED_TRACE(row.why);
    EXPECT_EQ(wire_bits(row.frame), digits(row.bits) + tail_bits);
    EXPECT_EQ(wire_crc(row.frame), row.crc);
  }
}

TEST(FrameLength, CrcOfThePublishedCheckString) {
  detail::StuffCounter counter;
  for (const char c : std::string("123456789")) {
    counter.put(static_cast<std::uint8_t>(c), 8);
  }
  EXPECT_EQ(counter.crc(), 0x059E);  // the check value of CRC-15/CAN
}

TEST(FrameLength, ErrorReportsAreNeverOnTheWire) {
  const Frame report{0x4, FrameKind::error, 8, {}};
  EXPECT_EQ(wire_bits(report), 0);
  EXPECT_EQ(wire_crc(report), 0);
}

struct BoundsCase {
  FrameKind kind;
  std::uint8_t length;
  int shortest;
  int longest;
};

TEST(FrameLength, Bounds) {
  const BoundsCase cases[] = {
      {extended, 0, 67, 80},         {extended, 1, 75, 90},        {extended, 8, 131, 160},
      {extended, 9, 131, 160},       {extended, 255, 131, 160},    {standard, 0, 47, 55},
      {standard, 1, 55, 65},         {standard, 8, 111, 135},      {standard, 15, 111, 135},
      {extended_remote, 8, 67, 80},  {extended_remote, 0, 67, 80}, {standard_remote, 8, 47, 55},
      {standard_remote, 15, 47, 55},
  };
  for (const BoundsCase& row : cases) {
    EXPECT_EQ(shortest_bits(row.kind, row.length), row.shortest) << int{row.length};
    EXPECT_EQ(longest_bits(row.kind, row.length), row.longest) << int{row.length};
  }
}

// The reference: a frame as a string of bits, after ISO 11898-1, with nothing of the library in it.

std::string crc_of(std::string bits) {
  const std::string divisor = "1100010110011001";  // x15+x14+x10+x8+x7+x4+x3+1
  const std::size_t length = bits.size();
  bits += std::string(15, '0');
  for (std::size_t i = 0; i < length; ++i) {
    if (bits[i] == '1') {
      for (std::size_t k = 0; k < divisor.size(); ++k) {
        bits[i + k] = bits[i + k] == divisor[k] ? '0' : '1';
      }
    }
  }
  return bits.substr(length);
}

std::string stuffed(const std::string& bits) {
  std::string wire;
  std::size_t start = 0;  // where a run of five may begin
  for (const char bit : bits) {
    wire += bit;
    if (wire.size() - start >= 5 && wire.substr(wire.size() - 5) == std::string(5, bit)) {
      start = wire.size();
      wire += bit == '0' ? '1' : '0';
    }
  }
  return wire;
}

std::string frame_bits(const Frame& frame) {
  const std::string id = is_extended(frame.kind) ? std::bitset<29>(frame.id).to_string()
                                                 : std::bitset<11>(frame.id).to_string();
  const std::string remote = is_remote(frame.kind) ? "1" : "0";
  std::string bits = "0" + id.substr(0, 11);
  bits += is_extended(frame.kind) ? "11" + id.substr(11) + remote + "00" : remote + "00";
  bits += std::bitset<4>(frame.length).to_string();
  for (int i = 0; i < std::min<int>(frame.length, 8) && !is_remote(frame.kind); ++i) {
    bits += std::bitset<8>(frame.data[i]).to_string();
  }
  return bits;
}

Frame random_frame(std::mt19937& generator) {
  constexpr FrameKind kinds[] = {standard, standard_remote, extended, extended_remote};
  Frame frame{};
  frame.kind = kinds[test::up_to(generator, 3)];
  frame.length = static_cast<std::uint8_t>(test::up_to(generator, 15));
  // Long runs of equal bits are where stuffing happens: half of the frames are made of them.
  const bool runs = test::up_to(generator, 1) == 0;
  constexpr std::uint8_t run_bytes[] = {0x00, 0xFF, 0x0F, 0xF0, 0x1F, 0xF8, 0x83, 0x7C};
  const auto byte = [&] {
    return runs ? run_bytes[test::up_to(generator, 7)]
                : static_cast<std::uint8_t>(test::up_to(generator, 255));
  };
  for (std::uint8_t& data : frame.data) {
    data = byte();
  }
  for (int i = 0; i < 4; ++i) {
    frame.id = (frame.id << 8) | byte();
  }
  frame.id &= max_id(frame.kind);
  return frame;
}

TEST(FrameLength, AgreesWithTheFrameWrittenOutBitByBit) {
  std::mt19937 generator = test::seeded_generator();
  for (int i = 0; i < 50'000; ++i) {
    const Frame frame = random_frame(generator);
    const std::string bits = frame_bits(frame);
    const std::string crc = crc_of(bits);
    const std::string wire = stuffed(bits + crc);
    ASSERT_EQ(wire_bits(frame), wire.size() + tail_bits) << bits;
    ASSERT_EQ(wire_crc(frame), std::bitset<15>(crc).to_ulong()) << bits;
    ASSERT_GE(wire_bits(frame), shortest_bits(frame.kind, frame.length)) << bits;
    ASSERT_LE(wire_bits(frame), longest_bits(frame.kind, frame.length)) << bits;
  }
}

TEST(FrameLength, TheReferenceAgreesWithTheHandWorkedFrames) {
  for (const HandWorked& row : hand_worked) {
    std::string wire = row.bits;
    wire.erase(
        std::remove_if(wire.begin(), wire.end(), [](char c) { return c != '0' && c != '1'; }),
        wire.end());
    const std::string bits = frame_bits(row.frame);
    EXPECT_EQ(stuffed(bits + crc_of(bits)), wire) << row.why;
  }
}

}  // namespace
}  // namespace roio
