#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <roio/bit_timing.hpp>
#include <string>
#include <tuple>

#include "seed.hpp"

namespace roio {
namespace {

constexpr std::uint32_t mhz = 1'000'000;
constexpr BitTiming impossible{};

static_assert(sizeof(BitTiming) == 6, "a byte a field");
static_assert(compute_bit_timing(16 * mhz, 500'000) == BitTiming{1, 6, 7, 2, 1, false},
              "usable at compile time");
static_assert(bit_timing<16 * mhz, 500'000>() == BitTiming{1, 6, 7, 2, 1, false},
              "checked at compile time");
static_assert(bit_timing<16 * mhz, 500'000, 750>() == BitTiming{1, 5, 6, 4, 2, false},
              "with another sample point");
static_assert(bit_timing<8 * mhz, 83'333>() == compute_bit_timing(8 * mhz, 83'333),
              "the template and the function agree");
static_assert(!is_valid(compute_bit_timing(8 * mhz, 1'000'000)), "told apart at compile time");
static_assert(bitrate_bps(original_bit_timing(125), 16 * mhz) == 125'000, "at compile time");
static_assert(sample_point_permille(original_bit_timing(125)) == 625, "at compile time");

/// "/2 1+6+7+2 sjw 1": all of a timing, to be read in a failure.
std::string text(const BitTiming& timing) {
  return "/" + std::to_string(2 * timing.prescaler) + " 1+" + std::to_string(timing.prop_seg) +
         "+" + std::to_string(timing.phase_seg1) + "+" + std::to_string(timing.phase_seg2) +
         " sjw " + std::to_string(timing.sjw) + (timing.triple_sampling ? " triple" : "");
}

struct GoldenTiming {
  const char* why;
  std::uint32_t osc_hz;
  std::uint32_t bitrate_bps;
  BitTiming expected;
  int sample_point;
};

// Worked out by hand: pairs of clocks a bit = oscillator / 2 / rate, split into prescaler x quanta.
// 16 quanta are sampled at 14/16 = 875; 20 reach 17/20 = 850, since no segment is longer than 8; 25
// have no choice but 17/25 = 680. Segments and sample points are also what Linux prints
// (can-calc-bit-timing mcp251x), except where a row says otherwise; its sjw is always 1.
const GoldenTiming golden_timings[] = {
    {"400 = 25 x 16", 8 * mhz, 10'000, {25, 6, 7, 2, 1, false}, 875},
    {"200 = 10 x 20; not a multiple of 16", 8 * mhz, 20'000, {10, 8, 8, 3, 1, false}, 850},
    {"120.001 is nearly 8 x 15, and 13/15 beats 17/20",
     8 * mhz,
     33'333,
     {8, 6, 6, 2, 1, false},
     866},
    {"80 = 5 x 16", 8 * mhz, 50'000, {5, 6, 7, 2, 1, false}, 875},
    {"48.0002 is nearly 3 x 16", 8 * mhz, 83'333, {3, 6, 7, 2, 1, false}, 875},
    {"40 = 2 x 20", 8 * mhz, 100'000, {2, 8, 8, 3, 1, false}, 850},
    {"32 = 2 x 16", 8 * mhz, 125'000, {2, 6, 7, 2, 1, false}, 875},
    {"16 = 1 x 16", 8 * mhz, 250'000, {1, 6, 7, 2, 1, false}, 875},
    {"8 = 1 x 8; phase_seg2 of 1 would be 875, but the chip needs 2",
     8 * mhz,
     500'000,
     {1, 2, 3, 2, 1, false},
     750},
    {"5 = 1 x 5, the shortest bit there is; Linux wants 6",
     8 * mhz,
     800'000,
     {1, 1, 1, 2, 1, false},
     600},
    {"4 quanta are too few", 8 * mhz, 1'000'000, impossible, 0},

    {"800 = 50 x 16", 16 * mhz, 10'000, {50, 6, 7, 2, 1, false}, 875},
    {"400 = 25 x 16", 16 * mhz, 20'000, {25, 6, 7, 2, 1, false}, 875},
    {"240.002 is nearly 15 x 16", 16 * mhz, 33'333, {15, 6, 7, 2, 1, false}, 875},
    {"33,333.3 is 0.7 away", 16 * mhz, 33'334, {15, 6, 7, 2, 1, false}, 875},
    {"33,333.3 is 1.3 away", 16 * mhz, 33'332, {15, 6, 7, 2, 1, false}, 875},
    {"240.24: 33,333 is 0.1 % off", 16 * mhz, 33'300, {15, 6, 7, 2, 1, false}, 875},
    {"96.04: 83,333 is 0.04 % off", 16 * mhz, 83'300, {6, 6, 7, 2, 1, false}, 875},
    {"84.03: 95,238 is 0.04 % off; 6 x 14", 16 * mhz, 95'200, {6, 5, 6, 2, 1, false}, 857},
    {"48.02", 8 * mhz, 83'300, {3, 6, 7, 2, 1, false}, 875},
    {"42.02; 3 x 14", 8 * mhz, 95'200, {3, 5, 6, 2, 1, false}, 857},
    {"211 is prime, 210.5 is closest to 210: 38,095, 0.24 % off",
     16 * mhz,
     38'005,
     {14, 6, 6, 2, 1, false},
     866},
    {"160, 0.5 % off", 16 * mhz, 50'251, {10, 6, 7, 2, 1, false}, 875},
    {"and one more: 50,000 is off by more than 1 in 200, and 159 and 158 are no better", 16 * mhz,
     50'252, impossible, 0},
    {"160 = 10 x 16", 16 * mhz, 50'000, {10, 6, 7, 2, 1, false}, 875},
    {"96.0004 is nearly 6 x 16", 16 * mhz, 83'333, {6, 6, 7, 2, 1, false}, 875},
    {"80 = 5 x 16", 16 * mhz, 100'000, {5, 6, 7, 2, 1, false}, 875},
    {"64 = 4 x 16", 16 * mhz, 125'000, {4, 6, 7, 2, 1, false}, 875},
    {"36 = 2 x 18 = 3 x 12, both sampled at 833: more quanta win; Linux takes fewer",
     16 * mhz,
     222'222,
     {2, 7, 7, 3, 1, false},
     833},
    {"32 = 2 x 16", 16 * mhz, 250'000, {2, 6, 7, 2, 1, false}, 875},
    {"16 = 1 x 16", 16 * mhz, 500'000, {1, 6, 7, 2, 1, false}, 875},
    {"10 = 1 x 10, for 800 permille", 16 * mhz, 800'000, {1, 3, 4, 2, 1, false}, 800},
    {"8 = 1 x 8, for 750 permille", 16 * mhz, 1'000'000, {1, 2, 3, 2, 1, false}, 750},

    {"1000 = 50 x 20; 8 x 125 is past the prescaler",
     20 * mhz,
     10'000,
     {50, 8, 8, 3, 1, false},
     850},
    {"500 = 25 x 20", 20 * mhz, 20'000, {25, 8, 8, 3, 1, false}, 850},
    {"300.003 is nearly 20 x 15", 20 * mhz, 33'333, {20, 6, 6, 2, 1, false}, 866},
    {"200 = 10 x 20", 20 * mhz, 50'000, {10, 8, 8, 3, 1, false}, 850},
    {"120.0005 is nearly 8 x 15", 20 * mhz, 83'333, {8, 6, 6, 2, 1, false}, 866},
    {"100 = 5 x 20", 20 * mhz, 100'000, {5, 8, 8, 3, 1, false}, 850},
    {"80 = 5 x 16", 20 * mhz, 125'000, {5, 6, 7, 2, 1, false}, 875},
    {"40 = 2 x 20", 20 * mhz, 250'000, {2, 8, 8, 3, 1, false}, 850},
    {"20 = 1 x 20", 20 * mhz, 500'000, {1, 8, 8, 3, 1, false}, 850},
    {"12.5; Linux takes 769,230", 20 * mhz, 800'000, impossible, 0},
    {"10 = 1 x 10; 750 is between two quanta, the early one wins",
     20 * mhz,
     1'000'000,
     {1, 3, 3, 3, 1, false},
     700},

    {"phase_seg2 of 5 leaves room for a wider sjw",
     40 * mhz,
     1'000'000,
     {1, 7, 7, 5, 2, false},
     750},
    {"25 quanta, the widest sjw", 40 * mhz, 800'000, {1, 8, 8, 8, 4, false}, 680},
    {"1600 = 64 x 25, the longest bit there is", 16 * mhz, 5'000, {64, 8, 8, 8, 4, false}, 680},
    {"5,000 is exactly 1 away", 16 * mhz, 4'999, {64, 8, 8, 8, 4, false}, 680},
    {"25 away, of 24 that are allowed", 16 * mhz, 4'975, impossible, 0},
    {"kbit/s where bit/s are asked for", 16 * mhz, 500, impossible, 0},

    {"no oscillator", 0, 500'000, impossible, 0},
    {"no rate", 16 * mhz, 0, impossible, 0},
    {"neither", 0, 0, impossible, 0},
    {"no oscillator, and the smallest rate", 0, 1, impossible, 0},
    {"as fast as the oscillator", 16 * mhz, 16 * mhz, impossible, 0},
    {"faster than the oscillator", 16 * mhz, 16 * mhz + 1, impossible, 0},
    {"megahertz where hertz are asked for", 16, 500'000, impossible, 0},
    {"the largest rate there is", 16 * mhz, UINT32_MAX, impossible, 0},
    {"both at their largest", UINT32_MAX, UINT32_MAX, impossible, 0},
    {"far too slow", UINT32_MAX, 1, impossible, 0},
    {"the fastest bus there is, 40 MHz", 40'000'000, 1'000'000, {1, 7, 7, 5, 2, false}, 750},
    {"faster than that", 40'000'000, 1'000'001, impossible, 0},
    {"twice as fast, though the clock would do", 40'000'000, 2'000'000, impossible, 0},
};

TEST(BitTiming, GoldenTimings) {
  for (const GoldenTiming& row : golden_timings) {
    SCOPED_TRACE(std::to_string(row.osc_hz) + " Hz, " + std::to_string(row.bitrate_bps) +
                 " bit/s: " + row.why);
    const BitTiming timing = compute_bit_timing(row.osc_hz, row.bitrate_bps);
    EXPECT_EQ(text(timing), text(row.expected));
    EXPECT_EQ(timing, row.expected);
    EXPECT_EQ(is_valid(timing), row.expected != impossible);
    EXPECT_EQ(sample_point_permille(timing), row.sample_point);
  }
}

struct SamplePointCase {
  const char* why;
  std::uint32_t osc_hz;
  std::uint16_t asked;
  BitTiming expected;
};

TEST(BitTiming, SamplePointsAt500Kbit) {
  const SamplePointCase cases[] = {
      {"12/16", 16 * mhz, 750, {1, 5, 6, 4, 2, false}},
      {"one less: 11/16 = 687 is early, so it beats 750", 16 * mhz, 749, {1, 5, 5, 5, 2, false}},
      {"10/12 is 833.3", 12 * mhz, 833, {1, 4, 5, 2, 1, false}},
      {"one less is 9/12", 12 * mhz, 832, {1, 4, 4, 3, 1, false}},
      {"9/16 is 562.5", 16 * mhz, 562, {1, 4, 4, 7, 3, false}},
      {"phase_seg2 may not pass prop_seg + phase_seg1: late for want of anything earlier",
       16 * mhz,
       561,
       {1, 4, 4, 7, 3, false}},
      {"none at all", 16 * mhz, 0, {1, 4, 4, 7, 3, false}},
      {"phase_seg2 is 2 at least", 16 * mhz, 1000, {1, 6, 7, 2, 1, false}},
      {"above 1000", 16 * mhz, UINT16_MAX, {1, 6, 7, 2, 1, false}},
      {"prop_seg + phase_seg1 is 16 at most, also of 20", 20 * mhz, 1000, {1, 8, 8, 3, 1, false}},
  };
  for (const SamplePointCase& row : cases) {
    SCOPED_TRACE(std::to_string(row.asked) + ": " + row.why);
    EXPECT_EQ(text(compute_bit_timing(row.osc_hz, 500'000, row.asked)), text(row.expected));
  }
}

TEST(BitTiming, DefaultSamplePointIsThatOfLinux) {
  EXPECT_EQ(default_sample_point_permille(0), 875);
  EXPECT_EQ(default_sample_point_permille(500'000), 875);
  EXPECT_EQ(default_sample_point_permille(500'001), 800);
  EXPECT_EQ(default_sample_point_permille(800'000), 800);
  EXPECT_EQ(default_sample_point_permille(800'001), 750);
  EXPECT_EQ(default_sample_point_permille(UINT32_MAX), 750);
}

struct RuleCase {
  const char* why;
  BitTiming timing;
  bool valid;
};

TEST(BitTiming, EachRuleOfTheChipAtItsEdgeAndOnePast) {
  const RuleCase cases[] = {
      {"all at their least", {1, 1, 1, 2, 1, false}, true},
      {"all at their most", {64, 8, 8, 8, 4, true}, true},
      {"all zero", {0, 0, 0, 0, 0, false}, false},
      {"prescaler 0", {0, 8, 8, 8, 4, false}, false},
      {"prescaler 65", {65, 8, 8, 8, 4, false}, false},
      {"prop_seg 0", {1, 0, 8, 8, 4, false}, false},
      {"prop_seg 9", {1, 9, 8, 8, 4, false}, false},
      {"phase_seg1 0", {1, 8, 0, 8, 4, false}, false},
      {"phase_seg1 9", {1, 8, 9, 8, 4, false}, false},
      {"phase_seg2 1", {1, 8, 8, 1, 0, false}, false},
      {"phase_seg2 1, sjw 1", {1, 8, 8, 1, 1, false}, false},
      {"phase_seg2 9", {1, 8, 8, 9, 4, false}, false},
      {"sjw 0", {1, 8, 8, 8, 0, false}, false},
      {"sjw 5", {1, 8, 8, 8, 5, false}, false},
      {"prop_seg + phase_seg1 equal to phase_seg2", {1, 3, 5, 8, 4, false}, true},
      {"prop_seg + phase_seg1 less than phase_seg2", {1, 3, 4, 8, 4, false}, false},
      {"phase_seg2 above sjw", {1, 8, 8, 5, 4, false}, true},
      {"phase_seg2 equal to sjw", {1, 8, 8, 4, 4, false}, false},
      {"no field wraps", {255, 255, 255, 255, 255, true}, false},
  };
  for (const RuleCase& row : cases) {
    SCOPED_TRACE(row.why);
    EXPECT_EQ(is_valid(row.timing), row.valid);
    EXPECT_EQ(bitrate_bps(row.timing, 40 * mhz) != 0, row.valid);
    EXPECT_EQ(sample_point_permille(row.timing) != 0, row.valid);
  }
}

TEST(BitTiming, RealRateAndSamplePoint) {
  const BitTiming shortest{1, 1, 1, 2, 1, false};
  EXPECT_EQ(quanta_per_bit(shortest), 5);
  EXPECT_EQ(bitrate_bps(shortest, 8 * mhz), 800'000U);
  EXPECT_EQ(bitrate_bps(shortest, 9), 0U) << "rounded down";
  EXPECT_EQ(bitrate_bps(shortest, UINT32_MAX), 429'496'729U);
  EXPECT_EQ(sample_point_permille(shortest), 600);

  const BitTiming longest{64, 8, 8, 8, 4, false};
  EXPECT_EQ(quanta_per_bit(longest), 25);
  EXPECT_EQ(bitrate_bps(longest, 16 * mhz), 5'000U);
  EXPECT_EQ(sample_point_permille(longest), 680);

  EXPECT_EQ(bitrate_bps({15, 6, 7, 2, 1, false}, 16 * mhz), 33'333U) << "rounded down";
  EXPECT_EQ(sample_point_permille({8, 6, 6, 2, 1, false}), 866) << "rounded down";
  EXPECT_EQ(quanta_per_bit({255, 255, 255, 255, 255, true}), 766) << "never wraps to 0";
}

TEST(BitTiming, DiffersInEachField) {
  const BitTiming timing{1, 2, 3, 4, 1, false};
  EXPECT_NE(timing, (BitTiming{2, 2, 3, 4, 1, false}));
  EXPECT_NE(timing, (BitTiming{1, 3, 3, 4, 1, false}));
  EXPECT_NE(timing, (BitTiming{1, 2, 4, 4, 1, false}));
  EXPECT_NE(timing, (BitTiming{1, 2, 3, 5, 1, false}));
  EXPECT_NE(timing, (BitTiming{1, 2, 3, 4, 2, false}));
  EXPECT_NE(timing, (BitTiming{1, 2, 3, 4, 1, true}));
}

struct OriginalTiming {
  std::uint16_t kbps;
  BitTiming expected;
};

TEST(BitTiming, OriginalTable) {
  // Table 3.3 of the thesis; its "/2" to "/80" are clocks a quantum, twice the prescaler.
  const OriginalTiming cases[] = {
      {1000, {2 / 2, 1, 3, 3, 1, false}}, {500, {2 / 2, 3, 6, 6, 1, false}},
      {250, {8 / 2, 1, 3, 3, 1, false}},  {125, {8 / 2, 3, 6, 6, 1, false}},
      {10, {80 / 2, 5, 7, 7, 1, true}},
  };
  for (const OriginalTiming& row : cases) {
    SCOPED_TRACE(row.kbps);
    EXPECT_EQ(text(original_bit_timing(row.kbps)), text(row.expected));
    EXPECT_EQ(original_bit_timing(row.kbps), row.expected);
    EXPECT_TRUE(is_valid(row.expected));
    EXPECT_EQ(bitrate_bps(row.expected, 16 * mhz), row.kbps * 1000U);
  }
}

TEST(BitTiming, OriginalTableHasNothingElse) {
  int rows = 0;
  for (std::uint32_t kbps = 0; kbps <= UINT16_MAX; ++kbps) {
    const BitTiming timing = original_bit_timing(static_cast<std::uint16_t>(kbps));
    rows += timing != impossible;
    EXPECT_EQ(is_valid(timing), timing != impossible) << kbps;
  }
  EXPECT_EQ(rows, 5);
}

// The reference: every setting that the chip has, with the rules as the datasheet and the header
// say them, in 64 bits.

/// What the search goes by, best first: the rate, not late, close, many quanta.
using Rank = std::tuple<std::int64_t, bool, int, int>;

Rank rank_of(std::int64_t rate_error, int before, int quanta, int asked) {
  const int real = 1000 * before / quanta;
  return {rate_error, real > asked, std::abs(real - asked), -quanta};
}

/// In whole bit/s, 0 is the very rate.
std::int64_t rate_error(std::int64_t osc_hz, std::int64_t bitrate_bps, int prescaler, int quanta) {
  const std::int64_t clocks = std::int64_t{2} * prescaler * quanta;
  return std::abs(osc_hz - bitrate_bps * clocks) / clocks;
}

std::optional<Rank> best_of_all(std::uint32_t osc_hz, std::uint32_t bitrate_bps, int asked) {
  std::optional<Rank> best;
  if (osc_hz == 0 || bitrate_bps == 0 || bitrate_bps > 1'000'000) {
    return best;
  }
  for (int quanta = 5; quanta <= 25; ++quanta) {
    for (int prescaler = 1; prescaler <= 64; ++prescaler) {
      const std::int64_t off = rate_error(osc_hz, bitrate_bps, prescaler, quanta);
      if (off > bitrate_bps / 200) {
        continue;
      }
      for (int prop_seg = 1; prop_seg <= 8; ++prop_seg) {
        for (int phase_seg1 = 1; phase_seg1 <= 8; ++phase_seg1) {
          const int phase_seg2 = quanta - 1 - prop_seg - phase_seg1;
          if (phase_seg2 < 2 || phase_seg2 > 8 || prop_seg + phase_seg1 < phase_seg2) {
            continue;  // sjw 1 is below any phase_seg2 left
          }
          const Rank rank = rank_of(off, 1 + prop_seg + phase_seg1, quanta, asked);
          best = best ? std::min(*best, rank) : rank;
        }
      }
    }
  }
  return best;
}

struct Wish {
  std::uint32_t osc_hz;
  std::uint32_t bitrate_bps;
  std::uint16_t sample_point;
};

/// Of all sizes, from a bit to 32.
std::uint32_t any_number(std::mt19937& generator) {
  return test::up_to(generator, UINT32_MAX) >> test::up_to(generator, 31);
}

Wish random_wish(std::mt19937& generator) {
  constexpr std::uint32_t crystals[] = {8 * mhz,    10 * mhz, 12 * mhz, 14'745'600, 16 * mhz,
                                        18'432'000, 20 * mhz, 24 * mhz, 25 * mhz,   40 * mhz};
  Wish wish{};
  wish.osc_hz =
      test::up_to(generator, 1) == 0 ? crystals[test::up_to(generator, 9)] : any_number(generator);
  // Few rates drawn at random can be had: most are made from a setting, and at times 1 off.
  const std::uint32_t clocks =
      2 * (1 + test::up_to(generator, 63)) * (5 + test::up_to(generator, 20));
  wish.bitrate_bps = test::up_to(generator, 4) == 0
                         ? any_number(generator)
                         : wish.osc_hz / clocks + test::up_to(generator, 2) - 1;
  wish.sample_point = static_cast<std::uint16_t>(test::up_to(generator, 1000));
  if (test::up_to(generator, 2) == 0) {
    wish.sample_point = default_sample_point_permille(wish.bitrate_bps);
  }
  return wish;
}

TEST(BitTiming, NoSettingOfTheChipIsBetter) {
  std::mt19937 generator = test::seeded_generator();
  int found = 0;
  int refused = 0;
  int close = 0;
  for (int i = 0; i < 5'000; ++i) {
    const Wish wish = random_wish(generator);
    SCOPED_TRACE(std::to_string(wish.osc_hz) + " Hz, " + std::to_string(wish.bitrate_bps) +
                 " bit/s, sample point " + std::to_string(wish.sample_point));
    const BitTiming timing = compute_bit_timing(wish.osc_hz, wish.bitrate_bps, wish.sample_point);
    if (wish.osc_hz < 1 * mhz) {
      continue;  // none of the chip's, and rates that are no whole numbers any more: see below
    }
    const std::optional<Rank> best = best_of_all(wish.osc_hz, wish.bitrate_bps, wish.sample_point);
    ASSERT_EQ(is_valid(timing), best.has_value()) << text(timing);
    if (!best) {
      ASSERT_EQ(timing, impossible);
      ++refused;
      continue;
    }
    ++found;
    const int quanta = quanta_per_bit(timing);
    const std::int64_t off = rate_error(wish.osc_hz, wish.bitrate_bps, timing.prescaler, quanta);
    close += off > 0 ? 1 : 0;
    ASSERT_EQ(rank_of(off, quanta - timing.phase_seg2, quanta, wish.sample_point), *best)
        << text(timing);
    // How Linux shares out what lies before the sample point; and the jump that goes with it.
    ASSERT_EQ(timing.prop_seg, (timing.prop_seg + timing.phase_seg1) / 2) << text(timing);
    ASSERT_EQ(timing.sjw, std::max(1, std::min({4, int{timing.phase_seg1}, timing.phase_seg2 / 2})))
        << text(timing);
    ASSERT_FALSE(timing.triple_sampling);
  }
  // Either outcome was seen often enough to mean something.
  EXPECT_GT(found, 1'000);
  EXPECT_GT(refused, 300);
  EXPECT_GT(close, 100);
}

TEST(BitTiming, WhateverIsAskedForIsNeverAnotherRate) {
  std::mt19937 generator = test::seeded_generator();
  for (int i = 0; i < 20'000; ++i) {
    const Wish wish = random_wish(generator);
    const BitTiming timing = compute_bit_timing(wish.osc_hz, wish.bitrate_bps, wish.sample_point);
    if (is_valid(timing)) {
      ASSERT_LE(rate_error(wish.osc_hz, wish.bitrate_bps, timing.prescaler, quanta_per_bit(timing)),
                wish.bitrate_bps / 200)
          << wish.osc_hz << " Hz, " << wish.bitrate_bps << " bit/s";
    } else {
      ASSERT_EQ(timing, impossible);
    }
  }
}

}  // namespace
}  // namespace roio
