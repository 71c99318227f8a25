#include "listen/bus_words.hpp"

#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

namespace roio::cli {
namespace {

using Words = std::vector<std::string>;

struct Row {
  const char* name;
  Words named;
  Words words;
  Words buses;
  Words filters;
};

std::ostream& operator<<(std::ostream& out, const Row& row) {
  return out << row.name;
}

class BusWordsTable : public testing::TestWithParam<Row> {};

TEST_P(BusWordsTable, Splits) {
  const BusWords split = split_bus_words(GetParam().named, GetParam().words);
  EXPECT_EQ(split.buses, GetParam().buses);
  EXPECT_EQ(split.filters, GetParam().filters);
}

const Row rows[] = {
    {"nothing is nothing", {}, {}, {}, {}},
    {"the first word is a bus, whatever it looks like", {}, {"urgent"}, {"urgent"}, {}},
    {"an interface named without a number is a bus as the first",
     {},
     {"mybus", "urgent"},
     {"mybus"},
     {"urgent"}},
    {"what dump took before there were several",
     {},
     {"can0", "to=0.2", "or", "from=0.2"},
     {"can0"},
     {"to=0.2", "or", "from=0.2"}},
    {"a name and a number is one more",
     {},
     {"can0", "can1", "vcan12"},
     {"can0", "can1", "vcan12"},
     {}},
    {"so is what says its kind",
     {},
     {"can0", "local:x", "serial:auto", "socketcan:mybus", "urgent"},
     {"can0", "local:x", "serial:auto", "socketcan:mybus"},
     {"urgent"}},
    {"after the first filter all are filters, so that a bus there is told as a wrong one",
     {},
     {"can0", "urgent", "can1"},
     {"can0"},
     {"urgent", "can1"}},
    {"a misspelt filter stays one", {}, {"can0", "urgnet"}, {"can0"}, {"urgnet"}},
    {"an identifier and its mask end with a digit, too",
     {},
     {"can0", "123:700", "abc~700", "a:70"},
     {"can0"},
     {"123:700", "abc~700", "a:70"}},
    {"a number alone is no interface", {}, {"can0", "123"}, {"can0"}, {"123"}},
    {"an address is no interface",
     {},
     {"can0", "to=0.2", "from=can0"},
     {"can0"},
     {"to=0.2", "from=can0"}},
    {"one that is named lets the first word be a filter",
     {"mybus"},
     {"urgent"},
     {"mybus"},
     {"urgent"}},
    {"and more buses may follow", {"mybus"}, {"can0", "urgent"}, {"mybus", "can0"}, {"urgent"}},
    {"several that are named", {"mybus", "other"}, {}, {"mybus", "other"}, {}},
    {"an empty word is a filter, which is refused as one", {}, {"can0", ""}, {"can0"}, {""}},
};

INSTANTIATE_TEST_SUITE_P(All, BusWordsTable, testing::ValuesIn(rows));

TEST(BusWords, AFilterIsKnownByItsLook) {
  for (const char* word : {"urgent", "normal", "or", "to=0.2", "from=can0", "class=system", "=",
                           "123:700", "abc~700", "1000400A~1FFFFFFF"}) {
    EXPECT_TRUE(looks_like_filter(word)) << word;
  }
}
TEST(BusWords, ABusIsNoFilterThoughItsOptionsHaveAnEqualsSign) {
  for (const char* word : {"local:x?bitrate=500000", "serial:/dev/ttyACM0?mode=listen",
                           "serial:auto?baud=115200&bitrate=500000", "socketcan:mybus", "can0",
                           "local:abc", "serial:auto"}) {
    EXPECT_FALSE(looks_like_filter(word)) << word;
  }
}
TEST(BusWords, WhatMayBeEitherIsNoFilter) {
  for (const char* word : {"", "mybus", "urgnet", ":700", "~", "mybus:700", "123"}) {
    EXPECT_FALSE(looks_like_filter(word)) << word;
  }
}

}  // namespace
}  // namespace roio::cli
