// The pins as Roio knows them when compiling are Arduino's, on each board.
#include <gtest/gtest.h>

#include <ostream>

#include "rig.hpp"

namespace roio::load {
namespace {

struct Row {
  sim::BoardKind kind;
  int uart;
  const char* printed;
};

std::ostream& operator<<(std::ostream& out, const Row& row) {
  return out << sim::to_string(row.kind);
}

class PinMap : public testing::TestWithParam<Row> {};
// Of a Leonardo's 31, D24 to D30 are second names for pins below, or LEDs: they cost a lookup.
INSTANTIATE_TEST_SUITE_P(
    , PinMap,
    testing::Values(Row{sim::BoardKind::uno, 0, "20 pins, 20 known, 0 wrong\r\n"},
                    Row{sim::BoardKind::leonardo, 1, "31 pins, 24 known, 0 wrong\r\n"},
                    Row{sim::BoardKind::mega, 0, "70 pins, 70 known, 0 wrong\r\n"}),
    [](const testing::TestParamInfo<Row>& row) {
      return std::string(sim::to_string(row.param.kind));
    });

TEST_P(PinMap, IsArduinos) {
  sim::CanBus bus;
  sim::Board board(bus, GetParam().kind, image("PinMap", GetParam().kind));
  const Printed printed(board, GetParam().uart);
  bus.run_for(200ms);
  EXPECT_EQ(printed.text(), GetParam().printed);
}

}  // namespace
}  // namespace roio::load
