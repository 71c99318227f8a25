#include <gtest/gtest.h>

#include <bitset>
#include <roio/frame.hpp>
#include <string>

#include "seed.hpp"

namespace roio {
namespace {

struct ValidityCase {
  const char* why;
  Frame frame;
  bool valid;
};

TEST(Frame, IsValidUpToTheEdges) {
  const ValidityCase cases[] = {
      {"smallest", {0, FrameKind::standard, 0, {}}, true},
      {"largest standard identifier", {0x7FF, FrameKind::standard, 8, {}}, true},
      {"one past it", {0x800, FrameKind::standard, 8, {}}, false},
      {"largest standard remote identifier", {0x7FF, FrameKind::standard_remote, 8, {}}, true},
      {"one past it, remote", {0x800, FrameKind::standard_remote, 8, {}}, false},
      {"largest extended identifier", {0x1FFFFFFF, FrameKind::extended, 8, {}}, true},
      {"one past it", {0x20000000, FrameKind::extended, 8, {}}, false},
      {"largest extended remote identifier", {0x1FFFFFFF, FrameKind::extended_remote, 0, {}}, true},
      {"one past it, remote", {0x20000000, FrameKind::extended_remote, 0, {}}, false},
      {"error report", {0x1FFFFFFF, FrameKind::error, 8, {}}, true},
      {"one past its largest class", {0x20000000, FrameKind::error, 8, {}}, false},
      {"nine bytes", {0, FrameKind::extended, 9, {}}, false},
      {"kind 3: an error report cannot be remote", {0, static_cast<FrameKind>(3), 0, {}}, false},
      {"kind 5", {0, static_cast<FrameKind>(5), 0, {}}, false},
      {"kind 7", {0, static_cast<FrameKind>(7), 0, {}}, false},
      {"kind past three bits", {0, static_cast<FrameKind>(8), 0, {}}, false},
  };
  for (const ValidityCase& row : cases) {
    EXPECT_EQ(is_valid(row.frame), row.valid) << row.why;
  }
}

TEST(Frame, TaggedIdentifierIsSocketCans) {
  EXPECT_EQ(tagged_id(FrameKind::standard, 0x7FF), 0x000007FFU);
  EXPECT_EQ(tagged_id(FrameKind::error, 0x004), 0x20000004U);
  EXPECT_EQ(tagged_id(FrameKind::standard_remote, 0x7FF), 0x400007FFU);
  EXPECT_EQ(tagged_id(FrameKind::extended, 0x1000400A), 0x9000400AU);
  EXPECT_EQ(tagged_id(Frame{0x1FFFFFFF, FrameKind::extended_remote, 0, {}}), 0xDFFFFFFFU);
}

/// The arbitration field and what follows of the control field, bit by bit as it is sent.
std::string arbitration_bits(FrameKind kind, std::uint32_t id) {
  const std::string remote = is_remote(kind) ? "1" : "0";
  if (!is_extended(kind)) {
    return std::bitset<11>(id).to_string() + remote + "0";  // RTR, IDE
  }
  const std::string bits = std::bitset<29>(id).to_string();
  return bits.substr(0, 11) + "11" + bits.substr(11) + remote;  // SRR and IDE, then RTR
}

enum class Winner { first, second, neither };

/// Both send; a sender that puts a 1 while the other puts a 0 drops out.
Winner arbitrate(const std::string& a, const std::string& b) {
  for (std::size_t i = 0; i < a.size() && i < b.size(); ++i) {
    if (a[i] != b[i]) {
      return a[i] == '0' ? Winner::first : Winner::second;
    }
  }
  return Winner::neither;
}

Winner by_key(std::uint32_t a, std::uint32_t b) {
  return a < b ? Winner::first : a > b ? Winner::second : Winner::neither;
}

TEST(Arbitration, KeyDecidesAsTheWireDoes) {
  constexpr FrameKind kinds[] = {FrameKind::standard, FrameKind::standard_remote,
                                 FrameKind::extended, FrameKind::extended_remote};
  std::mt19937 generator = test::seeded_generator();
  int equal = 0;
  for (int i = 0; i < 500'000; ++i) {
    const FrameKind kind_a = kinds[test::up_to(generator, 3)];
    const FrameKind kind_b = kinds[test::up_to(generator, 3)];
    std::uint32_t a = test::up_to(generator, 0x1FFFFFFF);
    // Mostly close to a: the same but for one bit, or the same.
    std::uint32_t b = i % 4 == 0 ? test::up_to(generator, 0x1FFFFFFF)
                                 : a ^ ((1U << test::up_to(generator, 29)) & 0x1FFFFFFFU);
    a = is_extended(kind_a) ? a : a >> 18;
    b = is_extended(kind_b) ? b : b >> 18;
    const Winner wire = arbitrate(arbitration_bits(kind_a, a), arbitration_bits(kind_b, b));
    ASSERT_EQ(by_key(arbitration_key(kind_a, a), arbitration_key(kind_b, b)), wire)
        << arbitration_bits(kind_a, a) << "\n"
        << arbitration_bits(kind_b, b);
    equal += wire == Winner::neither ? 1 : 0;
  }
  EXPECT_GT(equal, 0) << "ties were never tried";
}

TEST(Arbitration, AmongRoioFramesTheSmallerIdentifierWins) {
  std::mt19937 generator = test::seeded_generator();
  for (int i = 0; i < 100'000; ++i) {
    const Frame a{test::up_to(generator, 0x1FFFFFFF), FrameKind::extended, 0, {}};
    const Frame b{test::up_to(generator, 0x1FFFFFFF), FrameKind::extended, 8, {}};
    ASSERT_EQ(by_key(arbitration_key(a), arbitration_key(b)), by_key(a.id, b.id));
  }
}

TEST(Arbitration, EqualFirstElevenBits) {
  const std::uint32_t top = 0x555;
  const std::uint32_t keys[] = {
      arbitration_key(FrameKind::standard, top),
      arbitration_key(FrameKind::standard_remote, top),
      arbitration_key(FrameKind::extended, top << 18),
      arbitration_key(FrameKind::extended_remote, top << 18),
      arbitration_key(FrameKind::extended, (top << 18) + 1),
  };
  for (std::size_t i = 1; i < std::size(keys); ++i) {
    EXPECT_LT(keys[i - 1], keys[i]) << i;
  }
}

}  // namespace
}  // namespace roio
