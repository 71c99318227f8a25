// A sketch for the library of 2014, as it was written then: it prints what it gets, and answers.
#include "sketch_rig.hpp"

namespace roio::test {
namespace {

TEST(Classic2014, PrintsWhoSentWhatAndAnswers) {
  SketchRig rig(sim::BoardKind::uno, "Classic2014");
  rig.bus.run_for(500ms);
  rig.send({0, 2}, {7, 200});
  rig.bus.run_for(300ms);
  EXPECT_EQ(rig.lines, Texts{"0.10 7 200"});
  EXPECT_EQ(rig.received, (Texts{"0.2 > 0.10: 07", "0.2 > 0.10: 07 C8", "0.2 > 10.25: 2D",
                                 "0.2 > 10.25: 72 6F 69 6F 00 01 02 03", "0.2 > 0.*: 07",
                                 "0.2 > 10.*: 01", "0.2 > 0.*: 72 6F 69 6F 00 01 02 03"}));
}

TEST(Classic2014, KnowsABroadcast) {
  SketchRig rig(sim::BoardKind::uno, "Classic2014");
  rig.bus.run_for(500ms);
  rig.pc.send(frame_of({31, 254}, {0, broadcast_node}, {1}));
  rig.bus.run_for(300ms);
  EXPECT_EQ(rig.lines, Texts{"31.254 to all 1"});
}

}  // namespace
}  // namespace roio::test
