// A robot's bus with its bit rate, as open() takes it.
#include <gtest/gtest.h>

#include "names/robot.hpp"

namespace roio::cli {
namespace {

TEST(BusOf, HasTheBitRateWhereItTakesOne) {
  const struct {
    const char* why;
    const char* bus;
    std::optional<std::uint32_t> bitrate;
    const char* expected;
  } rows[] = {
      {"no rate", "local:r", std::nullopt, "local:r"},
      {"a rate", "local:r", 125000, "local:r?bitrate=125000"},
      {"behind another option", "serial:auto?mode=listen", 125000,
       "serial:auto?mode=listen&bitrate=125000"},
      {"its own", "serial:auto?bitrate=125000", 125000, "serial:auto?bitrate=125000"},
      {"none of an interface of the kernel's", "can0", 125000, "can0"},
      {"no bus", "", 125000, ""},
  };
  for (const auto& row : rows) {
    Robot robot;
    robot.bus = row.bus;
    robot.bitrate = row.bitrate;
    EXPECT_EQ(bus_of(robot), row.expected) << row.why;
    EXPECT_TRUE(bus_of(robot).empty() || parse_bus_url(bus_of(robot))) << row.why;
  }
}

}  // namespace
}  // namespace roio::cli
