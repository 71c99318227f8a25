#include <gtest/gtest.h>

#include <roio/filter_socketcan.hpp>
#include <vector>

#include "universe.hpp"

namespace roio {
namespace {

constexpr FrameKind kinds[] = {FrameKind::standard, FrameKind::standard_remote, FrameKind::extended,
                               FrameKind::extended_remote};

TEST(ToSocketCan, GoldenFilters) {
  // docs/protocol.md "Filters": the plain node 0.2.
  const SocketCanFilter own = to_socketcan({0x00004000, 0x03FFE000, FilterMeaning::own_address});
  EXPECT_EQ(own.can_id, 0x80004000U);
  EXPECT_EQ(own.can_mask, 0xC3FFE000U);
  const SocketCanFilter all = to_socketcan({0, 0, FilterMeaning::everything});
  EXPECT_EQ(all.can_id, 0x80000000U);
  EXPECT_EQ(all.can_mask, 0xC0000000U);
}

TEST(ToSocketCan, AcceptsExactlyTheProgramAndOnlyExtendedData) {
  std::mt19937 generator = test::seeded_generator();
  for (int round = 0; round < 500; ++round) {
    const test::Universe universe(generator);
    const FilterRule rule = universe.random_rule(generator);
    const SocketCanFilter filter = to_socketcan(rule);
    for (std::uint32_t i = 0; i < universe.size(); ++i) {
      for (const FrameKind kind : kinds) {
        const std::uint32_t id = universe.id(i) & max_id(kind);
        ASSERT_EQ(accepts(filter, tagged_id(kind, id)),
                  kind == FrameKind::extended && accepts(rule, id));
      }
    }
  }
}

struct KernelCase {
  const char* why;
  SocketCanFilter filter;
  std::uint32_t tagged;
  bool accepted;
};

TEST(SocketCanFilter, DoesWhatTheKernelDoes) {
  const KernelCase cases[] = {
      {"mask 0 takes everything, standard", {0, 0}, 0x000007FF, true},
      {"mask 0 takes everything, extended remote", {0, 0}, 0xDFFFFFFF, true},
      {"identifier only: an extended frame with the same low bits passes",
       {0x123, 0x7FF},
       0x80000123,
       true},
      {"identifier only: high bits do not matter", {0x123, 0x7FF}, 0x80000923, true},
      {"other identifier", {0x123, 0x7FF}, 0x00000122, false},
      {"standard only keeps extended away", {0x123, 0x800007FF}, 0x80000123, false},
      {"standard only takes remote unless masked", {0x123, 0x800007FF}, 0x40000123, true},
      {"standard data only", {0x123, 0xC00007FF}, 0x40000123, false},
      {"standard only compares no bit above the 11", {0x12345123, 0x9FFFFFFF}, 0x00000123, true},
      {"extended only", {0x80000123, 0x9FFFFFFF}, 0x00000123, false},
      {"extended compares all 29", {0x92345123, 0x9FFFFFFF}, 0x80000123, false},
      {"inverted takes all others", {0x20000123, 0x7FF}, 0x00000122, true},
      {"inverted rejects its own", {0x20000123, 0x7FF}, 0x00000123, false},
      {"inverted mask 0 takes nothing", {0x20000000, 0}, 0x00000000, false},
      {"bits of can_id outside the mask do not matter", {0x7FF, 0x00F}, 0x0000000F, true},
  };
  for (const KernelCase& row : cases) {
    EXPECT_EQ(accepts(row.filter, row.tagged), row.accepted) << row.why;
  }
}

}  // namespace
}  // namespace roio
