// The bytes of numbered messages: golden ones, there and back, and what is none.
#include "gen/numbered.hpp"

#include <gtest/gtest.h>

#include <roio/text.hpp>
#include <string>
#include <tuple>
#include <vector>

namespace roio::cli {
namespace {

std::string written(Generator generator, std::uint32_t number, std::uint8_t length) {
  return to_hex(write_numbered(generator, number, length).data(), length);
}

std::optional<Numbered> read(const std::string& hex) {
  const Bytes bytes = *parse_hex(hex);
  return read_numbered({bytes.data.data(), bytes.length});
}

TEST(Numbered, WhereEachFieldLies) {
  // all but the check, which is byte 1
  const std::vector<std::tuple<const char*, Generator, std::uint32_t, std::uint8_t, std::string>>
      rows{
          {"4 bytes: 16 bits", {7, false}, 0x01020304, 4, "07??0304"},
          {"5 bytes: 24 bits", {7, false}, 0x01020304, 5, "07??020304"},
          {"6 bytes: all", {7, false}, 0x01020304, 6, "07??01020304"},
          {"its source varies", {7, true}, 0x01020304, 6, "87??01020304"},
          {"the last generator", {127, true}, 0xFFFFFFFF, 6, "FF??FFFFFFFF"},
      };
  for (const auto& [what, generator, number, length, expected] : rows) {
    std::string text = written(generator, number, length);
    text.replace(2, 2, "??");
    EXPECT_EQ(text, expected) << what;
  }
}

// Worked out by another program, from docs/cli.md.
TEST(Numbered, WholeMessages) {
  EXPECT_EQ(written({7, false}, 0x01020304, 4), "07E50304");
  EXPECT_EQ(written({7, true}, 1, 6), "878000000001");
  EXPECT_EQ(written({7, false}, 0x01020304, 8), "07650102030438AC");
}

TEST(Numbered, ThereAndBack) {
  for (std::uint8_t length = shortest_numbered; length <= max_data_length; ++length) {
    for (const std::uint32_t number : {0U, 1U, 0xFFFFU, 0x10000U, 0x12345678U, 0xFFFFFFFFU}) {
      const auto numbered = read(written({42, false}, number, length));
      ASSERT_TRUE(numbered);
      EXPECT_EQ(numbered->bits, length == 4 ? 16 : length == 5 ? 24 : 32);
      const std::uint32_t mask = numbered->bits == 32 ? ~0U : (1U << numbered->bits) - 1U;
      EXPECT_EQ(numbered->number, number & mask);
      EXPECT_EQ(numbered->generator.id, 42);
      EXPECT_FALSE(numbered->generator.roams);
    }
  }
}

TEST(Numbered, EveryWrongBitIsFound) {
  for (std::uint8_t length = shortest_numbered; length <= max_data_length; ++length) {
    auto data = write_numbered({42, false}, 0x01234567, length);
    for (unsigned bit = 0; bit < 8U * length; ++bit) {
      data[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
      EXPECT_FALSE(read_numbered({data.data(), length})) << unsigned{length} << " " << bit;
      data[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    }
    EXPECT_FALSE(read_numbered({data.data(), length - 1U})) << "cut off";
  }
}

TEST(Numbered, WhatIsTooShortIsNone) {
  for (const char* hex : {"", "00", "0000", "000000", "0000000000000000", "FFFFFFFFFFFFFFFF"}) {
    EXPECT_FALSE(read(hex)) << hex;
  }
}

}  // namespace
}  // namespace roio::cli
