#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <roio/filter_mcp2515.hpp>
#include <set>
#include <vector>

#include "universe.hpp"

namespace roio {
namespace {

using Registers = std::array<std::uint8_t, 4>;

Registers registers(const std::uint8_t (&four)[4]) {
  return {four[0], four[1], four[2], four[3]};
}

TEST(Mcp2515Registers, EachIdentifierBitHasItsPlace) {
  // Datasheet, registers RXFnSIDH, RXFnSIDL, RXFnEID8, RXFnEID0.
  for (std::uint32_t bit = 0; bit < 29; ++bit) {
    Registers expected{};
    if (bit >= 21) {
      expected[0] = static_cast<std::uint8_t>(1U << (bit - 21));
    } else if (bit >= 18) {
      expected[1] = static_cast<std::uint8_t>(1U << (bit - 18 + 5));
    } else if (bit >= 16) {
      expected[1] = static_cast<std::uint8_t>(1U << (bit - 16));
    } else {
      expected[bit >= 8 ? 2 : 3] = static_cast<std::uint8_t>(1U << (bit % 8));
    }
    Registers four{};
    to_mcp2515_registers(1U << bit, four.data());
    EXPECT_EQ(four, expected) << "bit " << bit;
    EXPECT_EQ(from_mcp2515_registers(four.data()), 1U << bit);
  }
}

TEST(Mcp2515Registers, OtherBitsOfSidlAreIgnored) {
  const Registers four{0x80, 0x1C, 0x40, 0x0A};
  EXPECT_EQ(from_mcp2515_registers(four.data()), 0x1000400AU);
}

TEST(FitMcp2515, PlainNodeAsTheDocumentHasIt) {
  FilterProgram<2> program;
  ASSERT_EQ(compile(interest_of({0, 2}), program), Status::ok);
  const Mcp2515Filters image = fit_mcp2515(program);
  EXPECT_TRUE(image.exact);
  EXPECT_EQ(registers(image.mask[0]), (Registers{0x1F, 0xE3, 0xE0, 0x00}));
  EXPECT_EQ(registers(image.mask[1]), (Registers{0x1F, 0xE3, 0xE0, 0x00}));
  EXPECT_EQ(registers(image.filter[0]), (Registers{0x00, 0x08, 0x40, 0x00}));
  EXPECT_EQ(registers(image.filter[1]), (Registers{0x00, 0xEB, 0xE0, 0x00}));
  for (const int unused : {2, 3, 4, 5}) {
    EXPECT_EQ(registers(image.filter[unused]), (Registers{0x00, 0x08, 0x40, 0x00})) << unused;
  }
}

TEST(FitMcp2515, EverythingIsOpenMasks) {
  FilterProgram<1> program;
  ASSERT_EQ(program.add({0, 0, FilterMeaning::everything}), Status::ok);
  const Mcp2515Filters image = fit_mcp2515(program);
  EXPECT_TRUE(image.exact);
  EXPECT_EQ(registers(image.mask[0]), Registers{});
  EXPECT_EQ(registers(image.mask[1]), Registers{});
  EXPECT_EQ(registers(image.filter[0]), (Registers{0x00, 0x08, 0x00, 0x00})) << "extended only";
}

TEST(FitMcp2515, EmptyProgramListensForNobody) {
  const Mcp2515Filters image = fit_mcp2515(FilterProgram<1>());
  EXPECT_FALSE(image.exact);
  EXPECT_TRUE(accepts(image, 0x0C0000FF)) << "what the document names";
  EXPECT_FALSE(is_valid(unpack_id(0x0C0000FF))) << "and nobody may send";
  for (std::uint32_t bit = 0; bit < 29; ++bit) {
    EXPECT_FALSE(accepts(image, 0x0C0000FF ^ (1U << bit))) << "bit " << bit;
  }
}

TEST(FitMcp2515, SixSeparateIdentifiersFitExactly) {
  FilterProgram<6> program;
  // Of even parity, so none merge.
  for (const std::uint32_t id : {0b0000U, 0b0011U, 0b0101U, 0b0110U, 0b1001U, 0b1010U}) {
    ASSERT_EQ(program.add({id, id_mask, FilterMeaning::custom}), Status::ok);
  }
  EXPECT_TRUE(fit_mcp2515(program).exact);
}

TEST(FitMcp2515, OverlappingRulesThatFitAreNotWidened) {
  // Two halves of all identifiers overlap in a quarter: kept apart, they let three quarters
  // through, although their sizes add up to the whole.
  FilterProgram<2> program;
  ASSERT_EQ(program.add({1, 1, FilterMeaning::custom}), Status::ok);
  ASSERT_EQ(program.add({2, 2, FilterMeaning::custom}), Status::ok);
  const Mcp2515Filters image = fit_mcp2515(program);
  EXPECT_TRUE(image.exact);
  EXPECT_FALSE(accepts(image, 0));
}

/// What every fitting must be, tried on every identifier of the universe and on others.
template <std::uint8_t Capacity>
void expect_sound(const FilterProgram<Capacity>& program, const Mcp2515Filters& image,
                  const test::Universe& universe, std::mt19937& generator) {
  bool accepts_more = false;
  for (std::uint32_t i = 0; i < universe.size(); ++i) {
    const std::uint32_t id = universe.id(i);
    ASSERT_TRUE(accepts(image, id) || !program.accepts(id)) << "rejects a wanted id " << id;
    accepts_more = accepts_more || (accepts(image, id) && !program.accepts(id));
    const std::uint32_t elsewhere = test::up_to(generator, id_mask);
    ASSERT_TRUE(accepts(image, elsewhere) || !program.accepts(elsewhere));
  }
  if (!program.empty()) {
    ASSERT_EQ(image.exact, !accepts_more);
  }
}

/// Filters cannot be switched off: every one must be one that the fitting means.
void expect_no_stray_filter(const Mcp2515Filters& image) {
  for (const auto& filter : image.filter) {
    ASSERT_EQ(filter[1] & 0x1C, Mcp2515Filters::exide) << "extended only, unused bits 0";
  }
  for (const auto& mask : image.mask) {
    ASSERT_EQ(mask[1] & 0x1C, 0) << "unused bits 0";
  }
}

template <std::uint8_t Capacity>
FilterProgram<Capacity> random_program(const test::Universe& universe, std::mt19937& generator,
                                       std::size_t rules) {
  FilterProgram<Capacity> program;
  for (const FilterRule& rule : universe.random_rules(generator, rules)) {
    EXPECT_EQ(program.add(rule), Status::ok);
  }
  return program;
}

TEST(FitMcp2515, NeverRejectsAndKnowsWhetherItIsExact) {
  std::mt19937 generator = test::seeded_generator();
  int exact = 0;
  int inexact = 0;
  for (int round = 0; round < 600; ++round) {
    const test::Universe universe(generator);
    const auto program = random_program<10>(universe, generator, test::up_to(generator, 10));
    const Mcp2515Filters image = fit_mcp2515(program);
    ++(image.exact ? exact : inexact);
    ASSERT_NO_FATAL_FAILURE(expect_sound(program, image, universe, generator));
    ASSERT_NO_FATAL_FAILURE(expect_no_stray_filter(image));
  }
  EXPECT_GT(exact, 0);
  EXPECT_GT(inexact, 0);
}

TEST(FitMcp2515, LongProgramsToo) {
  std::mt19937 generator = test::seeded_generator();
  for (int round = 0; round < 60; ++round) {
    const test::Universe universe(generator);
    const auto program = random_program<80>(universe, generator, 9 + test::up_to(generator, 71));
    const Mcp2515Filters image = fit_mcp2515(program);
    ASSERT_NO_FATAL_FAILURE(expect_sound(program, image, universe, generator));
  }
}

TEST(FitMcp2515, NodesWithManySubnetsAreHeard) {
  std::mt19937 generator = test::seeded_generator();
  for (int round = 0; round < 100; ++round) {
    const Interest wanted{{static_cast<std::uint8_t>(test::up_to(generator, 31)),
                           static_cast<std::uint8_t>(test::up_to(generator, 254))},
                          test::up_to(generator, 0xFFFFFFFF),
                          ClassSet{static_cast<std::uint8_t>(test::up_to(generator, 15))},
                          false};
    FilterProgram<80> program;
    ASSERT_EQ(compile(wanted, program), Status::ok);
    const Mcp2515Filters image = fit_mcp2515(program);
    for (std::uint32_t subnet = 0; subnet < 32; ++subnet) {
      for (std::uint32_t c = 0; c < 4; ++c) {
        const std::uint32_t to_all = ClassField::put(c) | DestinationSubnetField::put(subnet) |
                                     DestinationNodeField::put(255) |
                                     test::up_to(generator, 0x1FFF);
        ASSERT_TRUE(accepts(image, to_all) || !program.accepts(to_all));
      }
    }
  }
}

/// How few identifiers of the universe any sharing out of the rules over the six filters lets
/// through: all 6^n of them tried.
std::uint32_t tightest(const std::vector<FilterRule>& rules, const test::Universe& universe) {
  std::uint32_t ways = 1;
  for (std::size_t i = 0; i < rules.size(); ++i) {
    ways *= 6;
  }
  std::uint32_t best = universe.size();
  for (std::uint32_t way = 0; way < ways; ++way) {
    std::array<std::uint32_t, 2> masks{id_mask, id_mask};
    std::array<std::uint32_t, 6> match{};
    std::array<bool, 6> used{};
    std::uint32_t rest = way;
    for (const FilterRule& rule : rules) {
      const std::uint32_t f = rest % 6;
      rest /= 6;
      std::uint32_t& mask = masks[f < 2 ? 0 : 1];
      mask &= rule.mask & (used[f] ? ~(match[f] ^ rule.match) : id_mask);
      match[f] = used[f] ? match[f] : rule.match;
      used[f] = true;
    }
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < universe.size() && count < best; ++i) {
      bool passes = false;
      for (std::uint32_t f = 0; f < 6; ++f) {
        passes = passes || (used[f] && ((universe.id(i) ^ match[f]) & masks[f < 2 ? 0 : 1]) == 0);
      }
      count += passes ? 1U : 0U;
    }
    best = std::min(best, count);
  }
  return best;
}

void expect_tightest(std::mt19937& generator, std::uint32_t bits, std::uint32_t rule_count,
                     int rounds) {
  for (int round = 0; round < rounds; ++round) {
    const test::Universe universe(generator, bits);
    const auto program = random_program<8>(universe, generator, rule_count);
    const Mcp2515Filters image = fit_mcp2515(program);
    std::uint32_t passes = 0;
    for (std::uint32_t i = 0; i < universe.size(); ++i) {
      passes += accepts(image, universe.id(i)) ? 1U : 0U;
    }
    const std::vector<FilterRule> rules(program.begin(), program.end());
    ASSERT_EQ(passes, tightest(rules, universe));
  }
}

TEST(FitMcp2515, NoSharingOutIsTighter) {
  std::mt19937 generator = test::seeded_generator();
  for (std::uint32_t rules = 1; rules <= 4; ++rules) {
    ASSERT_NO_FATAL_FAILURE(expect_tightest(generator, 8, rules, 40));
  }
}

TEST(FitMcp2515, NoSharingOutIsTighterWhenItDoesNotFit) {
  std::mt19937 generator = test::seeded_generator();
  ASSERT_NO_FATAL_FAILURE(expect_tightest(generator, 6, 6, 20));
  ASSERT_NO_FATAL_FAILURE(expect_tightest(generator, 6, 7, 4));
}

// --- filters that keep the order -----------------------------------------------------------------

std::vector<Registers> all_registers(const Mcp2515Filters& image) {
  std::vector<Registers> all;
  for (const auto& mask : image.mask) {
    all.push_back(registers(mask));
  }
  for (const auto& filter : image.filter) {
    all.push_back(registers(filter));
  }
  return all;
}

TEST(FitMcp2515InOrder, APlainNodeIsThatOfTheDocumentWhicheverWayItIsMade) {
  for (int subnet = 0; subnet <= 31; ++subnet) {
    for (int node = 0; node <= 254; ++node) {
      const Address own{static_cast<std::uint8_t>(subnet), static_cast<std::uint8_t>(node)};
      FilterProgram<2> program;
      ASSERT_EQ(compile(interest_of(own), program), Status::ok);
      const Mcp2515Filters fitted = fit_mcp2515_in_order(program);
      const Mcp2515Filters direct = mcp2515_filters_of(own);
      if (program.size() == 2) {
        ASSERT_EQ(all_registers(direct), all_registers(fitted)) << subnet << '.' << node;
      } else {
        // One bit from the broadcast address: a program has one rule for both.
        for (std::uint32_t to = 0; to <= DestinationNodeField::largest(); ++to) {
          const std::uint32_t id =
              DestinationSubnetField::put(own.subnet) | DestinationNodeField::put(to);
          ASSERT_EQ(accepts(direct, id), to == own.node || to == broadcast_node);
          ASSERT_EQ(accepts(fitted, id), to == own.node || to == broadcast_node);
        }
      }
      ASSERT_TRUE(fitted.exact && fitted.in_order && direct.exact && direct.in_order);
    }
  }
  FilterProgram<2> program;
  ASSERT_EQ(compile(interest_of({0, 2}), program), Status::ok);
  EXPECT_EQ(all_registers(mcp2515_filters_of({0, 2})), all_registers(fit_mcp2515(program)));
}

TEST(FitMcp2515InOrder, EmptyProgramListensForNobody) {
  const Mcp2515Filters image = fit_mcp2515_in_order(FilterProgram<1>());
  EXPECT_TRUE(accepts(image, 0x0C0000FF));
  for (std::uint32_t bit = 0; bit < 29; ++bit) {
    EXPECT_FALSE(accepts(image, 0x0C0000FF ^ (1U << bit))) << "bit " << bit;
  }
}

/// Whether RXB0 accepts every identifier of the universe that RXB1 does.
bool rxb0_accepts_all(const Mcp2515Filters& image, const test::Universe& universe) {
  const auto passes = [&image](int filter, std::uint32_t id) {
    const std::uint32_t mask = from_mcp2515_registers(image.mask[filter < 2 ? 0 : 1]);
    return ((id ^ from_mcp2515_registers(image.filter[filter])) & mask) == 0;
  };
  for (std::uint32_t i = 0; i < universe.size(); ++i) {
    const std::uint32_t id = universe.id(i);
    const bool in_rxb0 = passes(0, id) || passes(1, id);
    if (!in_rxb0 && (passes(2, id) || passes(3, id) || passes(4, id) || passes(5, id))) {
      return false;
    }
  }
  return true;
}

TEST(FitMcp2515InOrder, NeverRejectsAndKnowsWhetherItIsExact) {
  std::mt19937 generator = test::seeded_generator();
  int exact = 0;
  int inexact = 0;
  int out_of_order = 0;
  for (int round = 0; round < 600; ++round) {
    const test::Universe universe(generator);
    const auto program = random_program<10>(universe, generator, test::up_to(generator, 10));
    const Mcp2515Filters image = fit_mcp2515_in_order(program);
    ++(image.exact ? exact : inexact);
    ASSERT_NO_FATAL_FAILURE(expect_sound(program, image, universe, generator));
    ASSERT_NO_FATAL_FAILURE(expect_no_stray_filter(image));
    ASSERT_TRUE(image.in_order);
    ASSERT_TRUE(rxb0_accepts_all(image, universe));
    const Mcp2515Filters wide = fit_mcp2515(program);
    if (!program.empty()) {  // what nobody sends lies outside of most universes
      ASSERT_EQ(wide.in_order, rxb0_accepts_all(wide, universe));
    }
    out_of_order += wide.in_order ? 0 : 1;
  }
  EXPECT_GT(exact, 0);
  EXPECT_GT(inexact, 0);
  EXPECT_GT(out_of_order, 0);
}

/// How few identifiers any sharing out of the rules over two filters behind one mask lets through.
std::uint32_t tightest_of_two(const std::vector<FilterRule>& rules,
                              const test::Universe& universe) {
  std::uint32_t best = universe.size();
  for (std::uint32_t way = 0; way < (1U << rules.size()); ++way) {
    std::uint32_t mask = id_mask;
    std::array<std::uint32_t, 2> match{};
    std::array<bool, 2> used{};
    for (std::size_t r = 0; r < rules.size(); ++r) {
      const std::size_t f = (way >> r) & 1U;
      mask &= rules[r].mask & (used[f] ? ~(match[f] ^ rules[r].match) : id_mask);
      match[f] = used[f] ? match[f] : rules[r].match;
      used[f] = true;
    }
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < universe.size(); ++i) {
      const std::uint32_t id = universe.id(i);
      const bool passes =
          (used[0] && ((id ^ match[0]) & mask) == 0) || (used[1] && ((id ^ match[1]) & mask) == 0);
      count += passes ? 1U : 0U;
    }
    best = std::min(best, count);
  }
  return best;
}

TEST(FitMcp2515InOrder, NoSharingOutIsTighter) {
  std::mt19937 generator = test::seeded_generator();
  for (std::uint32_t rules = 1; rules <= 8; ++rules) {
    for (int round = 0; round < 40; ++round) {
      const test::Universe universe(generator, 8);
      const auto program = random_program<8>(universe, generator, rules);
      const Mcp2515Filters image = fit_mcp2515_in_order(program);
      std::uint32_t passes = 0;
      for (std::uint32_t i = 0; i < universe.size(); ++i) {
        passes += accepts(image, universe.id(i)) ? 1U : 0U;
      }
      ASSERT_EQ(passes, tightest_of_two({program.begin(), program.end()}, universe));
    }
  }
}

}  // namespace
}  // namespace roio
