#include <gtest/gtest.h>

#include "parsing.hpp"

namespace roio {
namespace {

using test::Refusal;
using test::verdict;

struct AddressCase {
  const char* why;
  const char* text;
  Address address;
  const char* written;
};

TEST(AddressText, IsReadAndWritten) {
  const AddressCase cases[] = {
      {"smallest", "0.0", {0, 0}, "0.0"},
      {"largest of a node", "31.254", {31, 254}, "31.254"},
      {"broadcast", "7.*", {7, 255}, "7.*"},
      {"broadcast by its number", "31.255", {31, 255}, "31.*"},
  };
  for (const AddressCase& row : cases) {
    const auto parsed = parse_address(row.text);
    ASSERT_EQ(verdict(parsed), "ok") << row.why;
    EXPECT_EQ(*parsed, row.address) << row.why;
    EXPECT_EQ(to_string(*parsed), row.written) << row.why;
  }
}

TEST(AddressText, EveryAddressComesBack) {
  for (int subnet = 0; subnet <= max_subnet; ++subnet) {
    for (int node = 0; node <= broadcast_node; ++node) {
      const Address address{static_cast<std::uint8_t>(subnet), static_cast<std::uint8_t>(node)};
      const auto parsed = parse_address(to_string(address));
      ASSERT_EQ(verdict(parsed), "ok");
      EXPECT_EQ(*parsed, address);
      EXPECT_EQ(parse_source(to_string(address)).ok(), node != broadcast_node);
    }
  }
}

TEST(AddressText, RefusedInWords) {
  const Refusal cases[] = {
      {"node too large", "0.300",
       R"(address "0.300": node 300 is out of range; expected 0..254, or * for a broadcast)", 2},
      {"one past the broadcast", "0.256",
       R"(address "0.256": node 256 is out of range; expected 0..254, or * for a broadcast)", 2},
      {"subnet too large", "32.1", R"(address "32.1": subnet 32 is out of range; expected 0..31)",
       0},
      {"past 32 bits", "4294967296.1",
       R"(address "4294967296.1": subnet 4294967296 is out of range; expected 0..31)", 0},
      {"past 64 bits", "0.99999999999999999999",
       R"(address "0.99999999999999999999": node 99999999999999999999 is out of range; )"
       R"(expected 0..254, or * for a broadcast)",
       2},
      {"empty", "", R"(address "": no dot; expected SUBNET.NODE, such as 0.2)", 0},
      {"one number", "25", R"(address "25": no dot; expected SUBNET.NODE, such as 0.2)", 2},
      {"no subnet", ".2", R"(address ".2": subnet is missing; expected 0..31)", 0},
      {"no node", "0.", R"(address "0.": node is missing; expected 0..254, or * for a broadcast)",
       2},
      {"two dots", "0.2.3",
       R"(address "0.2.3": node "2.3" is not a number; expected 0..254, or * for a broadcast)", 2},
      {"negative", "-1.2", R"(address "-1.2": subnet "-1" is not a number; expected 0..31)", 0},
      {"plus sign", "0.+2",
       R"(address "0.+2": node "+2" is not a number; expected 0..254, or * for a broadcast)", 2},
      {"leading zero, octal to some", "0.010",
       R"(address "0.010": node "010" has a leading zero; expected 0..254, or * for a broadcast)",
       2},
      {"hexadecimal", "0.0x2",
       R"(address "0.0x2": node "0x2" is not a number; expected 0..254, or * for a broadcast)", 2},
      {"space before", " 0.2", R"(address " 0.2": subnet " 0" is not a number; expected 0..31)", 0},
      {"space after", "0.2 ",
       R"(address "0.2 ": node "2 " is not a number; expected 0..254, or * for a broadcast)", 2},
      {"every subnet", "*.2", R"(address "*.2": subnet "*" is not a number; expected 0..31)", 0},
      {"zero byte", std::string("0.2\0", 4),
       R"(address "0.2\x00": node "2\x00" is not a number; expected 0..254, or * for a broadcast)",
       2},
  };
  for (const Refusal& row : cases) {
    const auto parsed = parse_address(row.text);
    ASSERT_EQ(verdict(parsed), row.message) << row.why;
    EXPECT_EQ(parsed.error().offset, row.offset) << row.why;
  }
}

TEST(AddressText, SourceIsNoBroadcast) {
  const Refusal cases[] = {
      {"star", "31.*",
       R"(address "31.*": a broadcast is no address of a node's own; expected node 0..254)", 3},
      {"number", "0.255",
       R"(address "0.255": a broadcast is no address of a node's own; expected node 0..254)", 2},
      {"too large", "0.256", R"(address "0.256": node 256 is out of range; expected 0..254)", 2},
      {"subnet too large", "32.0", R"(address "32.0": subnet 32 is out of range; expected 0..31)",
       0},
  };
  for (const Refusal& row : cases) {
    const auto parsed = parse_source(row.text);
    ASSERT_EQ(verdict(parsed), row.message) << row.why;
    EXPECT_EQ(parsed.error().offset, row.offset) << row.why;
  }
}

}  // namespace
}  // namespace roio
