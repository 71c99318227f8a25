// TwoNodes: two chips on one Arduino, and what it says when one of them is missing.
#include "sketch_rig.hpp"

namespace roio::test {
namespace {

constexpr const char* no_first = "The first MCP2515 (CS on 10): no controller answers";
constexpr const char* no_second = "The second MCP2515 (CS on 9): no controller answers";

TEST(TwoNodes, SaysWhichChipIsMissing) {
  SketchRig only_first(sim::BoardKind::uno, "TwoNodes");
  EXPECT_EQ(only_first.run_for_lines(2500ms), Texts(2, no_second));

  sim::BoardOptions second;
  second.chip_select_pin = 9;
  SketchRig only_second(sim::BoardKind::uno, "TwoNodes", second);
  EXPECT_EQ(only_second.run_for_lines(2500ms), Texts(2, no_first));

  sim::BoardOptions none;
  none.has_chip = false;
  SketchRig without(sim::BoardKind::uno, "TwoNodes", none);
  EXPECT_EQ(without.run_for_lines(2500ms), (Texts{no_first, no_second, no_first, no_second}));
}

}  // namespace
}  // namespace roio::test
