#include <gtest/gtest.h>

#include <roio/bus.hpp>
#include <system_error>
#include <utility>

#include "parsing.hpp"

namespace roio {
namespace {

using test::Refusal;
using test::verdict;
using Kind = BusUrl::Kind;

struct UrlCase {
  const char* why;
  std::string text;
  Kind kind;
  std::string target;
  std::optional<std::uint32_t> bitrate;
};

TEST(BusUrlText, IsRead) {
  const std::string name_64(64, 'n');
  const UrlCase cases[] = {
      {"interface alone", "can0", Kind::socketcan, "can0", {}},
      {"interface with its kind", "socketcan:can0", Kind::socketcan, "can0", {}},
      {"named as a kind", "socketcan:local", Kind::socketcan, "local", {}},
      {"a kind's name without a colon is an interface", "local", Kind::socketcan, "local", {}},
      {"one byte", "c", Kind::socketcan, "c", {}},
      {"fifteen bytes", "can456789abcdef", Kind::socketcan, "can456789abcdef", {}},
      {"any other byte", "can-0.1_\xC3\xA4", Kind::socketcan, "can-0.1_\xC3\xA4", {}},
      {"local", "local:robot", Kind::local, "robot", {}},
      {"local, every kind of character", "local:A.z_0-9.", Kind::local, "A.z_0-9.", {}},
      {"64 bytes", "local:" + name_64, Kind::local, name_64, {}},
      {"slowest", "local:robot?bitrate=1000", Kind::local, "robot", 1000},
      {"fastest", "local:robot?bitrate=1000000", Kind::local, "robot", 1000000},
  };
  for (const UrlCase& row : cases) {
    const auto parsed = parse_bus_url(row.text);
    ASSERT_EQ(verdict(parsed), "ok") << row.why;
    EXPECT_EQ(parsed->kind, row.kind) << row.why;
    EXPECT_EQ(parsed->target, row.target) << row.why;
    EXPECT_EQ(parsed->bitrate, row.bitrate) << row.why;
  }
}

struct SerialCase {
  const char* why;
  std::string text;
  std::string target;
  std::optional<std::uint32_t> baud;
  std::optional<std::uint32_t> bitrate;
  std::optional<BridgeMode> mode;
};

TEST(BusUrlText, SerialIsRead) {
  const SerialCase cases[] = {
      {"a device", "serial:/dev/ttyACM0", "/dev/ttyACM0", {}, {}, {}},
      {"any bridge", "serial:auto", "auto", {}, {}, {}},
      {"a device in this folder", "serial:tty", "tty", {}, {}, {}},
      {"a colon in its name",
       "serial:/dev/serial/by-path/a:b",
       "/dev/serial/by-path/a:b",
       {},
       {},
       {}},
      {"slowest", "serial:p?baud=115200", "p", 115200, {}, {}},
      {"faster", "serial:p?baud=250000", "p", 250000, {}, {}},
      {"fast", "serial:p?baud=500000", "p", 500000, {}, {}},
      {"usual", "serial:p?baud=1000000", "p", 1000000, {}, {}},
      {"fastest", "serial:auto?baud=2000000", "auto", 2000000, {}, {}},
      {"slowest bus", "serial:p?bitrate=1000", "p", {}, 1000, {}},
      {"fastest bus", "serial:p?bitrate=1000000", "p", {}, 1000000, {}},
      {"normal", "serial:p?mode=normal", "p", {}, {}, BridgeMode::normal},
      {"listen", "serial:p?mode=listen", "p", {}, {}, BridgeMode::listen},
      {"loopback", "serial:p?mode=loopback", "p", {}, {}, BridgeMode::loopback},
      {"all", "serial:p?mode=listen&bitrate=125000&baud=500000", "p", 500000, 125000,
       BridgeMode::listen},
  };
  for (const SerialCase& row : cases) {
    const auto parsed = parse_bus_url(row.text);
    ASSERT_EQ(verdict(parsed), "ok") << row.why;
    EXPECT_EQ(parsed->kind, Kind::serial) << row.why;
    EXPECT_EQ(parsed->target, row.target) << row.why;
    EXPECT_EQ(parsed->baud, row.baud) << row.why;
    EXPECT_EQ(parsed->bitrate, row.bitrate) << row.why;
    EXPECT_EQ(parsed->mode, row.mode) << row.why;
  }
}

void expect_refused(const Refusal& row) {
  const auto parsed = parse_bus_url(row.text);
  ASSERT_EQ(verdict(parsed), "bus " + row.message) << row.why;
  EXPECT_EQ(parsed.error().offset, row.offset) << row.why;
}

TEST(BusUrlText, InterfaceRefusedInWords) {
  const Refusal cases[] = {
      {"empty", "", R"("": empty; expected an interface such as can0, local:NAME or serial:DEVICE)",
       0},
      {"unknown kind", "tcp:host",
       R"("tcp:host": unknown kind of bus "tcp"; expected an interface such as can0, local:NAME or serial:DEVICE)",
       0},
      {"kinds are lower case", "LOCAL:robot",
       R"("LOCAL:robot": unknown kind of bus "LOCAL"; )"
       R"(expected an interface such as can0, local:NAME or serial:DEVICE)",
       0},
      {"no kind", ":can0",
       R"(":can0": unknown kind of bus ""; expected an interface such as can0, local:NAME or serial:DEVICE)",
       0},
      {"no interface", "socketcan:",
       R"("socketcan:": an interface name of 0 bytes; expected 1..15, such as can0)", 10},
      {"sixteen bytes", "can456789abcdef0",
       R"("can456789abcdef0": an interface name of 16 bytes; expected 1..15, such as can0)", 0},
      {"a serial port without its kind", "/dev/ttyACM0",
       R"("/dev/ttyACM0": a path is no interface; )"
       R"(expected serial:/dev/ttyACM0 for the bridge on that serial port)",
       0},
      {"a port whose name is not fit to be shown", "/dev/\x1b[2J",
       R"("/dev/\x1B[2J": a path is no interface; )"
       R"(expected serial:DEVICE for the bridge on that serial port)",
       0},
      {"a path", "can0/x", R"("can0/x": "/" is not allowed in an interface name)", 4},
      {"a space", "socketcan:can 0",
       R"("socketcan:can 0": " " is not allowed in an interface name)", 13},
      {"a zero byte, which would end it", std::string("can\0x", 5),
       R"("can\x00x": "\x00" is not allowed in an interface name)", 3},
      {"a second colon", "socketcan:can:0",
       R"("socketcan:can:0": ":" is not allowed in an interface name)", 13},
      {"this folder", ".", R"(".": not an interface name; expected one such as can0)", 0},
      {"the folder above", "socketcan:..",
       R"("socketcan:..": not an interface name; expected one such as can0)", 10},
      {"options", "can0?bitrate=500000",
       R"("can0?bitrate=500000": an interface takes no options here; )"
       R"(`ip link set` sets its bit rate and the rest)",
       4},
      {"an option with a colon", "can0?x:y",
       R"("can0?x:y": an interface takes no options here; )"
       R"(`ip link set` sets its bit rate and the rest)",
       4},
  };
  for (const Refusal& row : cases) {
    expect_refused(row);
  }
}

TEST(BusUrlText, LocalRefusedInWords) {
  const Refusal cases[] = {
      {"no name", "local:", R"("local:": a bus name of 0 bytes; expected 1..64, such as robot)", 6},
      {"no name but options", "local:?bitrate=1000",
       R"("local:?bitrate=1000": a bus name of 0 bytes; expected 1..64, such as robot)", 6},
      {"65 bytes", "local:" + std::string(65, 'n'),
       R"("local:nnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnnn..." (71 bytes): )"
       R"(a bus name of 65 bytes; expected 1..64, such as robot)",
       6},
      {"a path", "local:../x",
       R"("local:../x": "/" is not allowed in a bus name; )"
       R"(expected letters, digits, '.', '_', '-')",
       8},
      {"hidden", "local:.robot", R"("local:.robot": a bus name must not start with a dot)", 6},
      {"empty options", "local:robot?",
       R"("local:robot?": an option without a name; expected bitrate=BPS)", 12},
      {"unknown option", "local:robot?speed=5",
       R"("local:robot?speed=5": unknown option "speed"; expected bitrate=BPS)", 12},
      {"no value", "local:robot?bitrate",
       R"("local:robot?bitrate": option bitrate has no value; expected bitrate=BPS)", 12},
      {"empty value", "local:robot?bitrate=",
       R"("local:robot?bitrate=": bitrate ""; )"
       R"(expected 1000..1000000 (bit/s), without leading zeros)",
       20},
      {"too slow", "local:robot?bitrate=999",
       R"("local:robot?bitrate=999": bitrate "999"; )"
       R"(expected 1000..1000000 (bit/s), without leading zeros)",
       20},
      {"too fast", "local:robot?bitrate=1000001",
       R"("local:robot?bitrate=1000001": bitrate "1000001"; )"
       R"(expected 1000..1000000 (bit/s), without leading zeros)",
       20},
      {"kilo", "local:robot?bitrate=500k",
       R"("local:robot?bitrate=500k": bitrate "500k"; )"
       R"(expected 1000..1000000 (bit/s), without leading zeros)",
       20},
      {"past 32 bits", "local:robot?bitrate=4294968296",
       R"("local:robot?bitrate=4294968296": bitrate "4294968296"; )"
       R"(expected 1000..1000000 (bit/s), without leading zeros)",
       20},
      {"repeated", "local:r?bitrate=1000&bitrate=1000",
       R"("local:r?bitrate=1000&bitrate=1000": option bitrate is given twice)", 21},
      {"trailing ampersand", "local:r?bitrate=1000&",
       R"("local:r?bitrate=1000&": an option without a name; expected bitrate=BPS)", 21},
  };
  for (const Refusal& row : cases) {
    expect_refused(row);
  }
}

TEST(BusUrlText, SerialRefusedInWords) {
  const Refusal cases[] = {
      {"no device",
       "serial:", R"("serial:": no device; expected one such as /dev/ttyACM0, or auto)", 7},
      {"no device but options", "serial:?baud=115200",
       R"("serial:?baud=115200": no device; expected one such as /dev/ttyACM0, or auto)", 7},
      {"a zero byte, which would end it", std::string("serial:a\0b", 10),
       R"("serial:a\x00b": "\x00" is not allowed in the name of a device)", 8},
      {"empty options", "serial:p?",
       R"("serial:p?": an option without a name; )"
       R"(expected baud=RATE, bitrate=BPS or mode=MODE)",
       9},
      {"unknown option", "serial:p?speed=5",
       R"("serial:p?speed=5": unknown option "speed"; )"
       R"(expected baud=RATE, bitrate=BPS or mode=MODE)",
       9},
      {"no value", "serial:p?baud",
       R"("serial:p?baud": option baud has no value; expected baud=RATE)", 9},
      {"a rate that no bridge has", "serial:p?baud=460800",
       R"("serial:p?baud=460800": baud "460800"; )"
       R"(expected 115200, 250000, 500000, 1000000 or 2000000)",
       14},
      {"a leading zero", "serial:p?baud=0115200",
       R"("serial:p?baud=0115200": baud "0115200"; )"
       R"(expected 115200, 250000, 500000, 1000000 or 2000000)",
       14},
      {"a bus too fast", "serial:p?bitrate=1000001",
       R"("serial:p?bitrate=1000001": bitrate "1000001"; )"
       R"(expected 1000..1000000 (bit/s), without leading zeros)",
       17},
      {"an unknown mode", "serial:p?mode=silent",
       R"("serial:p?mode=silent": mode "silent": expected normal, listen or loopback)", 14},
      {"an empty mode",
       "serial:p?mode=", R"("serial:p?mode=": mode "": expected normal, listen or loopback)", 14},
      {"repeated", "serial:p?baud=115200&mode=listen&baud=115200",
       R"("serial:p?baud=115200&mode=listen&baud=115200": option baud is given twice)", 33},
      {"not of a serial bus", "local:r?baud=115200",
       R"("local:r?baud=115200": unknown option "baud"; expected bitrate=BPS)", 8},
  };
  for (const Refusal& row : cases) {
    expect_refused(row);
  }
}

std::string refusal(const std::string& url) {
  try {
    static_cast<void>(open(url));
  } catch (const std::system_error& error) {
    return error.what();
  }
  return "(opened)";
}

TEST(BusUrlText, OpenSaysOnceWhatWasExpected) {
  EXPECT_EQ(refusal("tcp:host"),
            R"(bus "tcp:host": unknown kind of bus "tcp"; expected an interface such as can0, )"
            R"(local:NAME or serial:DEVICE: not the name of a bus)");
}

// Whether the kernel knows CAN or not.
TEST(BusUrlText, OpenGuessesWhatAWordWasMeantToBe) {
  const std::pair<const char*, const char*> cases[] = {
      {"robot9", "robot9 (did you mean local:robot9?): "},
      {"local", "local (did you mean local:robot?): "},
      {"ttyACM9", "ttyACM9 (did you mean serial:/dev/ttyACM9?): "},
      {"auto", "auto (did you mean serial:auto?): "},
      {"serial", "serial (did you mean serial:auto?): "},
      {"vcan99", "vcan99: "},
      {"no bus!", "bus \"no bus!\": "},
      {"odd_\xC3\xA4", "odd_\xC3\xA4: "},
  };
  for (const auto& [name, begin] : cases) {
    const std::string text = refusal(name);
    EXPECT_EQ(text.substr(0, std::string(begin).size()), begin);
  }
}

}  // namespace
}  // namespace roio
