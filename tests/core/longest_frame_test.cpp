// The longest and the shortest frame there is, of each kind and length: not by formula but by a
// search over all identifiers and data at once. The state of a transmitter is its CRC register, its
// last bit and how often that came in a row; for each state we keep the most and the fewest stuff
// bits with which it can be reached.
#include <gtest/gtest.h>

#include <algorithm>
#include <bitset>
#include <optional>
#include <roio/frame_length.hpp>
#include <string>
#include <vector>

namespace roio {
namespace {

struct Range {
  int fewest;
  int most;
};

struct State {
  unsigned crc;
  unsigned last;
  unsigned run;  ///< 1..4: five are followed by a stuff bit at once.
};

constexpr unsigned state_count = 0x8000U * 2 * 4;

unsigned index_of(const State& state) {
  return (state.crc * 2 + state.last) * 4 + state.run - 1;
}
State state_at(unsigned index) {
  return {index / 8, index / 4 % 2, index % 4 + 1};
}

/// Takes one more bit; tells how many stuff bits follow it.
int stuff(State& state, unsigned bit) {
  state.run = bit == state.last ? state.run + 1 : 1;
  state.last = bit;
  if (state.run < 5) {
    return 0;
  }
  state.run = 1;
  state.last = 1 - bit;
  return 1;
}

void feed_crc(State& state, unsigned bit) {
  const unsigned top = state.crc >> 14;
  state.crc = ((state.crc << 1) & 0x7FFF) ^ (top != bit ? 0x4599 : 0);
}

class Search {
 public:
  Search() : reached_(state_count) {}

  /// The first bit: start-of-frame.
  void start() {
    State state{0, 0, 1};
    feed_crc(state, 0);
    reached_[index_of(state)] = Range{0, 0};
  }

  /// One bit more: '0', '1', or 'x' for both.
  void step(char bit) {
    std::vector<std::optional<Range>> next(state_count);
    for (unsigned index = 0; index < state_count; ++index) {
      if (reached_[index]) {
        for (unsigned value = bit == '1' ? 1 : 0; value <= (bit == '0' ? 0U : 1U); ++value) {
          State state = state_at(index);
          const int added = stuff(state, value);
          feed_crc(state, value);
          widen(next[index_of(state)], *reached_[index], added);
        }
      }
    }
    reached_.swap(next);
  }

  /// The CRC that each state has, and what it adds.
  [[nodiscard]] Range finish() const {
    std::optional<Range> result;
    for (unsigned index = 0; index < state_count; ++index) {
      if (reached_[index]) {
        State state = state_at(index);
        const unsigned crc = state.crc;
        int added = 0;
        for (int shift = 14; shift >= 0; --shift) {
          added += stuff(state, (crc >> shift) & 1U);
        }
        widen(result, *reached_[index], added);
      }
    }
    return result.value();
  }

 private:
  static void widen(std::optional<Range>& target, const Range& from, int added) {
    const Range shifted{from.fewest + added, from.most + added};
    target = target ? Range{std::min(target->fewest, shifted.fewest),
                            std::max(target->most, shifted.most)}
                    : shifted;
  }

  std::vector<std::optional<Range>> reached_;
};

/// The bits after start-of-frame, up to the CRC; 'x' where they are free.
std::string pattern(FrameKind kind, unsigned length) {
  const std::string dlc = std::bitset<4>(length).to_string();
  const std::string data(8 * length, 'x');
  return is_extended(kind) ? std::string(11, 'x') + "11" + std::string(18, 'x') + "000" + dlc + data
                           : std::string(11, 'x') + "000" + dlc + data;
}

Range all_frames(FrameKind kind, unsigned length) {
  Search search;
  search.start();
  for (const char bit : pattern(kind, length)) {
    search.step(bit);
  }
  return search.finish();
}

struct LongestCase {
  FrameKind kind;
  std::uint8_t length;
  int shortest;
  int longest;
  Frame example;  ///< One of the longest.
};

class Longest : public testing::TestWithParam<LongestCase> {};

TEST_P(Longest, IsWhatTheDocumentSays) {
  const LongestCase& row = GetParam();
  const Range stuff_bits = all_frames(row.kind, row.length);
  const int bare = shortest_bits(row.kind, row.length);
  EXPECT_EQ(bare + stuff_bits.fewest, row.shortest);
  EXPECT_EQ(bare + stuff_bits.most, row.longest);
  EXPECT_LE(row.longest, longest_bits(row.kind, row.length));
  EXPECT_EQ(wire_bits(row.example), row.longest) << "the example is one of them";
}

// docs/protocol.md "Frame length".
constexpr FrameKind standard = FrameKind::standard;
constexpr FrameKind extended = FrameKind::extended;
const LongestCase longest_cases[] = {
    {standard, 0, 48, 53, {0x000, standard, 0, {}}},
    {standard, 1, 56, 62, {0x7C0, standard, 1, {0x7D}}},
    {standard, 8, 111, 133, {0x078, standard, 8, {0x01, 0xE1, 0xE1, 0xE1, 0xE1, 0xE1, 0xE0, 0x0F}}},
    {extended, 0, 68, 78, {0x07C30FFC, extended, 0, {}}},
    {extended, 1, 76, 88, {0x1F0C3FF0, extended, 1, {0xF0}}},
    {extended, 2, 84, 98, {0x1F0C3DF0, extended, 2, {0x08, 0x3C}}},
    {extended, 3, 92, 108, {0x01EE1E1E, extended, 3, {0xE1, 0xE1, 0xFF}}},
    {extended, 4, 99, 118, {0x1F0C1F0F, extended, 4, {0x00, 0xF0, 0xF0, 0xF0}}},
    {extended, 5, 107, 128, {0x17C30F0F, extended, 5, {0xF0, 0xF0, 0xF0, 0xFF, 0x87}}},
    {extended, 6, 115, 138, {0x000C3FE0, extended, 6, {0x0F, 0x0F, 0x0F, 0xF8, 0x78, 0x78}}},
    {extended, 7, 123, 148, {0x1F0C3C3E, extended, 7, {0x87, 0x87, 0x87, 0x87, 0x87, 0x80, 0x00}}},
    {extended,
     8,
     131,
     158,
     {0x000C3C3C, extended, 8, {0x3C, 0x3C, 0x3F, 0xFF, 0x0F, 0x0F, 0x0F, 0x0F}}},
};

INSTANTIATE_TEST_SUITE_P(Frame, Longest, testing::ValuesIn(longest_cases),
                         [](const auto& instance) {
                           return std::string(is_extended(instance.param.kind) ? "extended_"
                                                                               : "standard_") +
                                  std::to_string(instance.param.length);
                         });

}  // namespace
}  // namespace roio
