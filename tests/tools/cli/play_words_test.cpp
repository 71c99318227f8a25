// The words of `play` that are more than options: where frames go, and which part of the log.
#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "record/play_window.hpp"
#include "record/route_words.hpp"

namespace roio::cli {
namespace {

/// "can0>vcan0 *>vcan1", or what was wrong.
std::string routes(const std::vector<std::string>& words) {
  const auto parsed = parse_routes(words);
  if (!parsed) {
    return parsed.error().message;
  }
  std::string text;
  for (const auto& [name, bus] : parsed->bus_of) {
    text += name + ">" + parsed->buses[bus] + " ";
  }
  if (parsed->bus_of_all_others) {
    text += "*>" + parsed->buses[*parsed->bus_of_all_others] + " ";
  }
  return text + std::to_string(parsed->buses.size());
}

TEST(RouteWords, SayWhereFramesGo) {
  EXPECT_EQ(routes({"vcan0"}), "*>vcan0 1");
  EXPECT_EQ(routes({"vcan0=can0"}), "can0>vcan0 1");
  EXPECT_EQ(routes({"vcan0=can0", "vcan1=can1"}), "can0>vcan0 can1>vcan1 2");
  EXPECT_EQ(routes({"vcan0=can0", "vcan0=can1"}), "can0>vcan0 can1>vcan0 1");
  EXPECT_EQ(routes({"vcan0=can0", "vcan1"}), "can0>vcan0 *>vcan1 2");
  EXPECT_EQ(routes({"local:x=robot"}), "robot>local:x 1");
}
TEST(RouteWords, ABusMayHaveAnEqualsSign) {
  EXPECT_EQ(routes({"local:x?bitrate=500000"}), "*>local:x?bitrate=500000 1");
  EXPECT_EQ(routes({"local:x?bitrate=500000=can0"}), "can0>local:x?bitrate=500000 1");
  EXPECT_EQ(routes({"serial:auto?baud=115200"}), "*>serial:auto?baud=115200 1");
}
TEST(RouteWords, ContradictionsAreRefused) {
  EXPECT_EQ(routes({"vcan0", "vcan1"}),
            "BUS \"vcan1\": expected one BUS, or BUS=NAME for each interface of the log");
  EXPECT_EQ(routes({"vcan0=can0", "vcan1=can0"}),
            "BUS \"vcan1=can0\": \"can0\" goes to another bus already");
  EXPECT_EQ(routes({"vcan0="}),
            "BUS \"vcan0=\": expected the name of an interface in the log after '='");
}
TEST(RouteWords, OneBusHasOneName) {
  EXPECT_EQ(routes({"can0=a", "socketcan:can0=b"}),
            "BUS \"socketcan:can0=b\": the same as \"can0\"; expected one name of it");
  EXPECT_EQ(routes({"local:x=a", "local:x?bitrate=500000"}),
            "BUS \"local:x?bitrate=500000\": the same as \"local:x\"; expected one name of it");
  EXPECT_EQ(routes({"can0=a", "local:can0=b"}), "a>can0 b>local:can0 2");
}
TEST(RouteWords, WhatIsNoBusIsRefusedAsEverywhere) {
  EXPECT_EQ(routes({"/dev/ttyACM0"}),
            "bus \"/dev/ttyACM0\": a path is no interface; expected serial:/dev/ttyACM0 for the "
            "bridge on that serial port");
  EXPECT_EQ(routes({""}),
            "bus \"\": empty; expected an interface such as can0, local:NAME or serial:DEVICE");
}

std::string log_time(const std::string& text) {
  const auto parsed = parse_log_time(text);
  return parsed ? (parsed->since_first ? "+" : "") + std::to_string(parsed->time.count()) : "";
}

TEST(LogTime, IsAsTheLogHasItOrSinceItsFirst) {
  EXPECT_EQ(log_time("0"), "0");
  EXPECT_EQ(log_time("1436509052.249713"), "1436509052249713000");
  EXPECT_EQ(log_time("1436509052.000000001"), "1436509052000000001");
  EXPECT_EQ(log_time("+12.5"), "+12500000000");
  EXPECT_EQ(log_time("4000000000"), "4000000000000000000");
  EXPECT_EQ(log_time("007"), "7000000000");
}
TEST(LogTime, ElseIsRefused) {
  for (const char* text : {"", "+", "-1", "+-1", "1.", ".5", "1.0000000001", "1,5", "1s", "x",
                           "++1", "4000000001", "10000000000", "1e3", " 1", "(1.0)", "1.2.3"}) {
    EXPECT_EQ(log_time(text), "") << text;
  }
  EXPECT_EQ(parse_log_time("soon").error().message,
            "expected a time as the log has it, such as 1436509052.25, or +12.5 since its first "
            "frame, found \"soon\"");
}

// A letter for each frame: i inside, o outside, b behind.
std::string places(const char* from, const char* to, const std::vector<int>& times_ms) {
  const auto bound = [](const char* text) {
    return text == nullptr ? std::nullopt : std::optional(*parse_log_time(text));
  };
  PlayWindow window(bound(from), bound(to));
  std::string letters;
  for (const int time_ms : times_ms) {
    const auto time =
        time_ms < 0 ? std::nullopt : std::optional(Timestamp(std::chrono::milliseconds(time_ms)));
    letters += "iob"[static_cast<int>(window.place(time))];
  }
  return letters;
}

TEST(PlayWindow, IsFromOneTimeToAnother) {
  const std::vector<int> times{5000, 6000, 7000, 8000, 8001, 9000, 9001};
  EXPECT_EQ(places(nullptr, nullptr, times), "iiiiiii");
  EXPECT_EQ(places("6", nullptr, times), "oiiiiii");
  EXPECT_EQ(places("6.001", nullptr, times), "ooiiiii");
  EXPECT_EQ(places(nullptr, "8", times), "iiiioob");
  EXPECT_EQ(places("+1", "+3", times), "oiiioob");
  EXPECT_EQ(places("7", "6", times), "ooobbbb");
}
TEST(PlayWindow, ALogOfSeveralBusesMayBeOutOfOrder) {
  EXPECT_EQ(places(nullptr, "8", {7999, 8000, 8900, 7990, 9100, 7995}), "iioibi");
}
TEST(PlayWindow, WithoutATimeItIsWhereTheOneBeforeWas) {
  EXPECT_EQ(places("6", "7", {-1, 5000, -1, 6000, -1, 7500, -1}), "iooiioo");
}

}  // namespace
}  // namespace roio::cli
