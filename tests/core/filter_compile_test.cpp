// From what a node wants to a filter program.
#include <gtest/gtest.h>

#include <bit>
#include <roio/filter.hpp>
#include <vector>

#include "seed.hpp"

namespace roio {
namespace {

constexpr MessageClass message = MessageClass::message;
constexpr MessageClass system = MessageClass::system;
constexpr MessageClass stream = MessageClass::stream;

constexpr FilterMeaning own_address = FilterMeaning::own_address;
constexpr FilterMeaning broadcast = FilterMeaning::broadcast;
constexpr FilterMeaning everything = FilterMeaning::everything;

struct CompileCase {
  const char* why;
  Interest interest;
  std::vector<FilterRule> expected;
};

Interest interest(Address own, std::uint32_t broadcasts, ClassSet classes) {
  return {own, broadcasts, classes, false};
}

Interest all_of(ClassSet classes) {
  return {{0, 0}, 0, classes, true};
}

TEST(Compile, GoldenPrograms) {
  const ClassSet none = ClassSet::none();
  const CompileCase cases[] = {
      {"a plain node hears itself first, then its subnet",
       interest_of({0, 2}),
       {{0x00004000, 0x03FFE000, own_address}, {0x001FE000, 0x03FFE000, broadcast}}},
      {"the largest plain node: own and broadcast differ in one bit",
       interest_of({31, 254}),
       {{0x03FFC000, 0x03FFC000, FilterMeaning::custom}}},
      {"no broadcasts",
       interest({0, 2}, 0, ClassSet::all()),
       {{0x00004000, 0x03FFE000, own_address}}},
      {"one class is part of every rule",
       interest({0, 2}, 1, none.with(system)),
       {{0x04004000, 0x0FFFE000, own_address}, {0x041FE000, 0x0FFFE000, broadcast}}},
      {"neighbouring classes share a rule",
       interest({0, 2}, 1, none.with(message).with(system)),
       {{0x00004000, 0x0BFFE000, own_address}, {0x001FE000, 0x0BFFE000, broadcast}}},
      {"classes 0 and 2 differ in one bit too",
       interest({0, 2}, 0, none.with(message).with(stream)),
       {{0x00004000, 0x07FFE000, own_address}}},
      {"classes 1 and 2 do not",
       interest({0, 2}, 1, none.with(system).with(stream)),
       {{0x04004000, 0x0FFFE000, own_address},
        {0x08004000, 0x0FFFE000, own_address},
        {0x041FE000, 0x0FFFE000, broadcast},
        {0x081FE000, 0x0FFFE000, broadcast}}},
      {"three classes are two rules",
       interest({0, 2}, 0, none.with(message).with(system).with(stream)),
       {{0x00004000, 0x0BFFE000, own_address}, {0x08004000, 0x0FFFE000, own_address}}},
      {"no class is nothing", interest({0, 2}, 1, none), {}},
      {"bits past the four classes do not matter",
       interest({0, 2}, 0, ClassSet{0xFF}),
       {{0x00004000, 0x03FFE000, own_address}}},
      {"further subnets' broadcasts",
       interest({0, 2}, (1U << 0) | (1U << 31), ClassSet::all()),
       {{0x00004000, 0x03FFE000, own_address},
        {0x001FE000, 0x03FFE000, broadcast},
        {0x03FFE000, 0x03FFE000, broadcast}}},
      {"all subnets' broadcasts are one rule",
       interest({0, 2}, 0xFFFFFFFF, ClassSet::all()),
       {{0x00004000, 0x03FFE000, own_address}, {0x001FE000, 0x001FE000, broadcast}}},
      {"everything", all_of(ClassSet::all()), {{0, 0, everything}}},
      {"everything of one class",
       all_of(none.with(stream)),
       {{0x08000000, 0x0C000000, everything}}},
      {"everything of no class is nothing", all_of(none), {}},
  };
  for (const CompileCase& row : cases) {
    SCOPED_TRACE(row.why);
    FilterProgram<8> program;
    ASSERT_EQ(compile(row.interest, program), Status::ok);
    ASSERT_EQ(program.size(), row.expected.size());
    for (std::uint8_t i = 0; i < program.size(); ++i) {
      EXPECT_EQ(program[i].match, row.expected[i].match) << "rule " << int{i};
      EXPECT_EQ(program[i].mask, row.expected[i].mask) << "rule " << int{i};
      EXPECT_EQ(program[i].meaning, row.expected[i].meaning) << "rule " << int{i};
    }
  }
}

template <std::uint8_t Capacity>
void expect_untouched(const Interest& wanted, Status expected) {
  FilterProgram<Capacity> program;
  ASSERT_EQ(program.add({5, 7, FilterMeaning::custom}), Status::ok);
  EXPECT_EQ(compile(wanted, program), expected);
  ASSERT_EQ(program.size(), 1);
  EXPECT_EQ(program[0].match, 5U);
}

TEST(Compile, RefusesAnAddressThatNoNodeHas) {
  expect_untouched<8>(interest_of({32, 0}), Status::bad_argument);
  expect_untouched<8>(interest_of({0, 255}), Status::bad_argument);
  expect_untouched<8>({{0, 255}, 0, ClassSet::all(), true}, Status::bad_argument);
}

TEST(Compile, FullLeavesTheProgramAsItWas) {
  expect_untouched<1>(interest_of({0, 2}), Status::full);
  const ClassSet two_rules = ClassSet::none().with(system).with(stream);
  expect_untouched<3>(interest({0, 2}, 1, two_rules), Status::full);
  expect_untouched<1>({{0, 2}, 0, two_rules, true}, Status::full);
}

TEST(Compile, TheWorstInterestFitsInSixtySixRules) {
  // Subnets of even parity: no two of them differ in one bit.
  std::uint32_t apart = 0;
  for (std::uint32_t subnet = 0; subnet < 32; ++subnet) {
    apart |= (std::popcount(subnet) % 2 == 0 ? 1U : 0U) << subnet;
  }
  for (const std::uint32_t subnets : {apart, ~apart, 0xFFFFFFFFU, 0x7FFFFFFFU}) {
    for (std::uint8_t classes = 0; classes < 16; ++classes) {
      FilterProgram<66> program;
      EXPECT_EQ(compile(interest({0, 2}, subnets, ClassSet{classes}), program), Status::ok);
    }
  }
}

bool is_wanted(const Interest& wanted, const Header& header) {
  const bool own = header.destination == wanted.own;
  const bool broadcast_to_us = is_broadcast(header.destination) &&
                               ((wanted.broadcast_subnets >> header.destination.subnet) & 1U) != 0;
  return wanted.classes.has(header.message_class) && (wanted.everything || own || broadcast_to_us);
}

TEST(Compile, AcceptsWhatIsWantedAndNothingElse) {
  std::mt19937 generator = test::seeded_generator();
  const auto byte = [&generator](std::uint32_t max) {
    return static_cast<std::uint8_t>(test::up_to(generator, max));
  };
  for (int round = 0; round < 2'000; ++round) {
    const Interest wanted{{byte(31), byte(254)},
                          test::up_to(generator, 0xFFFFFFFF) & test::up_to(generator, 0xFFFFFFFF),
                          ClassSet{byte(15)},
                          byte(9) == 0};
    FilterProgram<80> program;
    ASSERT_EQ(compile(wanted, program), Status::ok);
    for (int i = 0; i < 200; ++i) {
      Header header = unpack_id(test::up_to(generator, id_mask));
      // Mostly addresses that matter: this node's, a broadcast, or one bit beside this node's.
      if (i % 4 == 0) {
        header.destination = wanted.own;
      } else if (i % 4 == 1) {
        header.destination.node = broadcast_node;
      } else if (i % 4 == 2) {
        header.destination = {wanted.own.subnet,
                              static_cast<std::uint8_t>(wanted.own.node ^ (1U << byte(7)))};
      }
      ASSERT_EQ(program.accepts(pack_id(header)), is_wanted(wanted, header))
          << std::hex << pack_id(header);
    }
  }
}

}  // namespace
}  // namespace roio
