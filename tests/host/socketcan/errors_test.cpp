// Error reports of the kernel, decoded. Bytes by hand from <linux/can/error.h>.
#include <gtest/gtest.h>

#include <roio/bus.hpp>
#include <roio/candump_log.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "socketcan/errors.hpp"

namespace roio::socketcan {
namespace {

struct Row {
  std::string_view why;
  std::string report;  // class after the error flag 20000000; data[1] controller, [6] TX, [7] RX
  BusState before;
  BusState after;
  bool entered_bus_off = false;
  bool overrun = false;
};

const std::vector<Row>& rows() {
  using enum BusState;
  static const std::vector<Row> table = {
      {"bus-off", "20000040#0000000000000000", passive, bus_off, true},
      {"bus-off again is entered again", "20000040#0000000000000000", bus_off, bus_off, true},
      {"bus-off beats all that comes with it", "20000344#0040000000000000", active, bus_off, true},
      {"restarted", "20000100#0000000000000000", bus_off, active},
      {"RX warning", "20000004#0004000000000000", active, warning},
      {"TX warning", "20000004#0008000000000000", active, warning},
      {"RX passive", "20000004#0010000000000000", warning, passive},
      {"TX passive", "20000004#0020000000000000", active, passive},
      {"passive beats warning", "20000004#0018000000000000", active, passive},
      {"passive falls back to warning", "20000004#0008000000000000", passive, warning},
      {"active again", "20000004#0040000000000000", passive, active},
      {"active again ends bus-off in old drivers", "20000004#0040000000000000", bus_off, active},
      {"controller problem, unspecified", "20000004#0000000000000000", warning, warning},
      {"RX overflow says nothing of the state", "20000004#0001000000000000", passive, passive,
       false, true},
      {"TX overflow is no overrun", "20000004#0002000000000000", active, active},
      {"RX overflow and warning", "20000004#0005000000000000", active, warning, false, true},
      {"the overflow bit counts only for controller problems", "20000008#0001000000000000", active,
       active},
      {"no acknowledgement", "20000020#0000000000000000", warning, warning},
      {"bus error", "20000088#0000080000000000", active, active},
      {"lost arbitration", "20000002#0500000000000000", active, active},
      {"counters 95", "20000200#0000000000005F5F", passive, active},
      {"TX counter 96", "20000200#0000000000006000", active, warning},
      {"RX counter 127", "20000200#000000000000007F", active, warning},
      {"TX counter 128", "20000200#0000000000008000", active, passive},
      {"RX counter 255", "20000200#00000000000000FF", active, passive},
      {"counters not flagged as valid", "20000008#000000000000FFFF", active, active},
      {"counters do not end bus-off", "20000200#0000000000000000", bus_off, bus_off},
      {"flags beat counters", "20000204#0008000000008000", active, warning},
      {"counters where the flags say nothing", "20000204#0002000000008000", active, passive},
      {"no class at all", "20000000#0000000000000000", passive, passive},
  };
  return table;
}

TEST(SocketCanErrors, ReportsAreDecoded) {
  for (const Row& row : rows()) {
    const Parsed<Frame> frame = parse_frame_text(row.report);
    ASSERT_TRUE(frame.ok()) << row.report;
    ASSERT_EQ(frame->kind, FrameKind::error) << row.report;
    const ErrorReport report = decode_error_report(*frame, row.before);
    EXPECT_STREQ(to_string(report.state), to_string(row.after)) << row.why;
    EXPECT_EQ(report.entered_bus_off, row.entered_bus_off) << row.why;
    EXPECT_EQ(report.overrun, row.overrun) << row.why;
  }
}

// Bytes that the report does not have are 0 in a Frame, so short ones need no case of their own.
TEST(SocketCanErrors, AReportShorterThanItShouldBeSaysNothing) {
  const Frame frame{0x204, FrameKind::error, 0, {}};
  const ErrorReport report = decode_error_report(frame, BusState::active);
  EXPECT_EQ(report.state, BusState::active);
  EXPECT_FALSE(report.overrun);
}

}  // namespace
}  // namespace roio::socketcan
