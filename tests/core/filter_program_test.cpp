#include <gtest/gtest.h>

#include <algorithm>
#include <roio/filter.hpp>
#include <vector>

#include "universe.hpp"

namespace roio {
namespace {

constexpr FilterMeaning custom = FilterMeaning::custom;

using Rules = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

template <std::uint8_t Capacity>
Rules rules_of(const FilterProgram<Capacity>& program) {
  Rules rules;
  for (const FilterRule& rule : program) {
    rules.emplace_back(rule.match, rule.mask);
  }
  return rules;
}

TEST(FilterRule, ContainsAndOverlaps) {
  const FilterRule everything{0, 0, custom};
  const FilterRule one{0b01, 0b11, custom};
  const FilterRule low{0b01, 0b01, custom};
  const FilterRule high{0b10, 0b10, custom};
  const FilterRule not_low{0b00, 0b01, custom};
  EXPECT_TRUE(contains(everything, one));
  EXPECT_FALSE(contains(one, everything));
  EXPECT_TRUE(contains(one, one));
  EXPECT_TRUE(contains(low, one));
  EXPECT_FALSE(contains(high, one));
  EXPECT_FALSE(contains(low, high)) << "they cross";
  EXPECT_TRUE(overlaps(low, high));
  EXPECT_FALSE(overlaps(low, not_low));
  EXPECT_TRUE(overlaps(everything, not_low));
}

TEST(FilterProgram, EmptyAcceptsNothing) {
  const FilterProgram<4> program;
  EXPECT_TRUE(program.empty());
  EXPECT_EQ(program.size(), 0);
  EXPECT_FALSE(program.accepts(0));
  EXPECT_FALSE(program.accepts(id_mask));
}

struct AddCase {
  const char* why;
  std::vector<FilterRule> added;
  Rules expected;
};

TEST(FilterProgram, AddMergesWithoutChangingTheSet) {
  const AddCase cases[] = {
      {"two that differ in two bits stay two",
       {{0b00, 0b11, custom}, {0b11, 0b11, custom}},
       {{0b00, 0b11}, {0b11, 0b11}}},
      {"two that differ in one bit become one",
       {{0b10, 0b11, custom}, {0b11, 0b11, custom}},
       {{0b10, 0b10}}},
      {"four become two become one",
       {{0b00, 0b11, custom}, {0b01, 0b11, custom}, {0b10, 0b11, custom}, {0b11, 0b11, custom}},
       {{0, 0}}},
      {"the same twice is once", {{5, 7, custom}, {5, 7, custom}}, {{5, 7}}},
      {"a rule within another is left out", {{1, 1, custom}, {3, 3, custom}}, {{1, 1}}},
      {"a rule around others replaces them, the rest keep their order",
       {{0b011, 0b111, custom},
        {0b100, 0b111, custom},
        {0b001, 0b111, custom},
        {0b001, 0b001, custom}},
       {{0b100, 0b111}, {0b001, 0b001}}},
      {"a merged rule merges on",
       {{0b000, 0b111, custom},
        {0b110, 0b110, custom},
        {0b010, 0b111, custom},
        {0b011, 0b111, custom},
        {0b001, 0b111, custom}},
       {{0b110, 0b110}, {0b000, 0b100}}},
      {"different masks do not merge",
       {{0b00, 0b11, custom}, {0b100, 0b101, custom}},
       {{0b00, 0b11}, {0b100, 0b101}}},
      {"everything swallows all", {{5, 7, custom}, {0, 0, custom}}, {{0, 0}}},
      {"the highest bit", {{0x10000000, 0x10000000, custom}}, {{0x10000000, 0x10000000}}},
  };
  for (const AddCase& row : cases) {
    SCOPED_TRACE(row.why);
    FilterProgram<8> program;
    for (const FilterRule& rule : row.added) {
      ASSERT_EQ(program.add(rule), Status::ok);
    }
    EXPECT_EQ(rules_of(program), row.expected);
  }
}

TEST(FilterProgram, MergedMeaningIsKeptOnlyWhenShared) {
  FilterProgram<4> program;
  ASSERT_EQ(program.add({0b00, 0b11, FilterMeaning::broadcast}), Status::ok);
  ASSERT_EQ(program.add({0b01, 0b11, FilterMeaning::broadcast}), Status::ok);
  EXPECT_EQ(program[0].meaning, FilterMeaning::broadcast);
  ASSERT_EQ(program.add({0b10, 0b10, FilterMeaning::own_address}), Status::ok);
  ASSERT_EQ(program.size(), 1);
  EXPECT_EQ(program[0].meaning, FilterMeaning::custom);
}

TEST(FilterProgram, RefusesBitsThatNoIdentifierHas) {
  FilterProgram<2> program;
  ASSERT_EQ(program.add({1, 1, custom}), Status::ok);
  EXPECT_EQ(program.add({0, 0x20000000, custom}), Status::bad_argument);
  EXPECT_EQ(program.add({0x20000000, 0x20000000, custom}), Status::bad_argument);
  EXPECT_EQ(program.add({2, 1, custom}), Status::bad_argument) << "match outside mask";
  EXPECT_EQ(rules_of(program), (Rules{{1, 1}}));
}

TEST(FilterProgram, FullLeavesItAsItWas) {
  FilterProgram<2> program;
  ASSERT_EQ(program.add({0b0000, 0b1111, custom}), Status::ok);
  ASSERT_EQ(program.add({0b0011, 0b1111, custom}), Status::ok);
  const Rules before = rules_of(program);
  EXPECT_EQ(program.add({0b1111, 0b1111, custom}), Status::full);
  EXPECT_EQ(rules_of(program), before);
  EXPECT_EQ(program.add({0b0001, 0b1111, custom}), Status::ok) << "merges, so it needs no room";
  EXPECT_EQ(program.add({0b0000, 0b1100, custom}), Status::ok) << "frees room, then takes it";
  EXPECT_EQ(rules_of(program), (Rules{{0b0000, 0b1100}}));
}

TEST(FilterProgram, ClearForgetsAll) {
  FilterProgram<1> program;
  ASSERT_EQ(program.add({0, 0, custom}), Status::ok);
  program.clear();
  EXPECT_TRUE(program.empty());
  EXPECT_FALSE(program.accepts(0));
}

TEST(FilterProgram, AcceptsExactlyTheUnionOfWhatWasAdded) {
  std::mt19937 generator = test::seeded_generator();
  for (int round = 0; round < 1'000; ++round) {
    const test::Universe universe(generator);
    const std::vector<FilterRule> rules =
        universe.random_rules(generator, test::up_to(generator, 20));
    FilterProgram<20> program;
    for (const FilterRule& rule : rules) {
      ASSERT_EQ(program.add(rule), Status::ok);
    }
    ASSERT_LE(program.size(), rules.size());
    for (std::uint32_t i = 0; i < universe.size(); ++i) {
      const std::uint32_t id = universe.id(i);
      ASSERT_EQ(program.accepts(id), test::any_accepts(rules, id)) << "id " << id;
      const std::uint32_t elsewhere = test::up_to(generator, id_mask);
      ASSERT_EQ(program.accepts(elsewhere), test::any_accepts(rules, elsewhere));
    }
  }
}

TEST(FilterProgram, ContainsAndOverlapsAgreeWithCounting) {
  std::mt19937 generator = test::seeded_generator();
  for (int round = 0; round < 1'000; ++round) {
    const test::Universe universe(generator);
    const FilterRule a = universe.random_rule(generator);
    const FilterRule b = universe.random_rule(generator);
    bool within = true;
    bool shared = false;
    for (std::uint32_t i = 0; i < universe.size(); ++i) {
      const bool in_a = accepts(a, universe.id(i));
      const bool in_b = accepts(b, universe.id(i));
      within = within && (in_a || !in_b);
      shared = shared || (in_a && in_b);
    }
    ASSERT_EQ(contains(a, b), within);
    ASSERT_EQ(overlaps(a, b), shared);
  }
}

}  // namespace
}  // namespace roio
