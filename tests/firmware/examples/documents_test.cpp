// The sketches that the documents show first do what is said of them.
#include <vector>

#include "sketch_rig.hpp"

namespace roio::test {
namespace {

constexpr Address node{0, 2};

TEST(DocumentSketch, OfTheReadmeSwitchesAPin) {
  SketchRig rig(sim::BoardKind::uno, "ProjectReadme");
  std::vector<bool> levels;
  rig.bus.run_for(20ms);
  rig.board.on_pin(8, [&](sim::SimTime, bool high) { levels.push_back(high); });
  rig.send(node, {1});
  rig.bus.run_for(5ms);
  rig.send(node, {1, 2});  // no order: left alone
  rig.bus.run_for(5ms);
  EXPECT_EQ(levels, std::vector<bool>{true});
  rig.send(node, {0});
  rig.bus.run_for(5ms);
  EXPECT_EQ(levels, (std::vector<bool>{true, false}));
}

TEST(DocumentSketch, OfTheArduinoPageSendsBack) {
  SketchRig rig(sim::BoardKind::uno, "ArduinoDocument");
  rig.bus.run_for(20ms);
  rig.send(node, {0x5A, 0x2D});
  EXPECT_EQ(rig.run(5ms), Texts{"0.2 > 0.10: 5A 2D"});
}

}  // namespace
}  // namespace roio::test
