// Checker: what it says of numbers that came, did not come, came twice or late.
#include "gen/checker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <tuple>
#include <vector>

namespace roio::cli {
namespace {

Message message(Address source, Generator generator, std::uint32_t number, std::uint8_t length) {
  Message message{{Priority::normal, MessageClass::message, {30, 254}, source}, length, {}};
  const auto data = write_numbered(generator, number, length);
  std::copy(data.begin(), data.end(), message.data);
  return message;
}

using Numbers = std::vector<std::uint32_t>;

Numbers range(std::uint32_t first, std::uint32_t count) {
  Numbers numbers(count);
  std::generate(numbers.begin(), numbers.end(), [&] { return first++; });
  return numbers;
}
Numbers operator+(Numbers a, const Numbers& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

std::string said_of(const Numbers& numbers, std::uint8_t length = 8) {
  Checker checker;
  for (const std::uint32_t number : numbers) {
    EXPECT_TRUE(checker.add(message({0, 10}, {7, false}, number, length)));
  }
  return to_string(checker.reports().at(0));
}

TEST(Checker, WhatItSaysOfNumbers) {
  const std::vector<std::tuple<const char*, Numbers, std::string>> rows{
      {"all", range(0, 100), "100 received, from number 0, 0 lost, 0 doubled, 0 out of order"},
      {"started late", range(50, 10),
       "10 received, from number 50, 0 lost, 0 doubled, 0 out of order"},
      {"one missing", {0, 1, 3}, "3 received, from number 0, 1 lost, 0 doubled, 0 out of order"},
      {"many missing",
       {0, 100000},
       "2 received, from number 0, 99999 lost, 0 doubled, 0 out of order"},
      {"one twice", {0, 1, 1, 2}, "4 received, from number 0, 0 lost, 1 doubled, 0 out of order"},
      {"the first twice", {5, 5}, "2 received, from number 5, 0 lost, 1 doubled, 0 out of order"},
      {"one thrice", {0, 1, 1, 1}, "4 received, from number 0, 0 lost, 2 doubled, 0 out of order"},
      {"late is not lost",
       {0, 2, 1, 3},
       "4 received, from number 0, 0 lost, 0 doubled, 1 out of order"},
      {"late, and then again",
       {0, 2, 1, 1},
       "4 received, from number 0, 0 lost, 1 doubled, 1 out of order"},
      {"one before the first was never missed",
       {5, 4, 6},
       "3 received, from number 5, 0 lost, 0 doubled, 1 out of order"},
      {"twice, at the edge of the window", range(10000, Sequence::window) + Numbers{10000},
       "4097 received, from number 10000, 0 lost, 1 doubled, 0 out of order"},
      {"beyond it nobody knows whether it was lost",
       range(10000, Sequence::window + 1) + Numbers{10000},
       "4098 received, from number 10000, 0 lost, 0 doubled, 1 out of order"},
      {"late, where a number of a window ago had come",
       range(10000, 4500) + range(14501, 10) + Numbers{14500},
       "4511 received, from number 10000, 0 lost, 0 doubled, 1 out of order"},
      {"late after a gap wider than the window",
       {0, 10000, 9000},
       "3 received, from number 0, 9998 lost, 0 doubled, 1 out of order"},
      {"began anew", range(0, 10000) + range(0, 10),
       "10010 received, from number 0, 0 lost, 0 doubled, 0 out of order, began anew 1 time"},
      {"began anew, the fewest that say so", range(0, 10000) + range(0, 3),
       "10003 received, from number 0, 0 lost, 0 doubled, 0 out of order, began anew 1 time"},
      {"began anew, and some were lost and doubled then",
       range(0, 10000) + range(1, 3) + Numbers{3, 5},
       "10005 received, from number 0, 1 lost, 1 doubled, 0 out of order, began anew 1 time"},
      {"one straggler of the first is no new beginning",
       range(0, 10000) + Numbers{5} + range(10000, 10),
       "10011 received, from number 0, 0 lost, 0 doubled, 1 out of order"},
      {"two in a row are none either", range(0, 10000) + Numbers{5, 6} + range(10000, 10),
       "10012 received, from number 0, 0 lost, 0 doubled, 2 out of order"},
      {"nor are three, with others between", range(0, 10000) + Numbers{5, 6, 10000, 7, 10001},
       "10005 received, from number 0, 0 lost, 0 doubled, 3 out of order"},
      {"late beyond the window stays lost",
       {0, 10000, 5000},
       "3 received, from number 0, 9999 lost, 0 doubled, 1 out of order"},
      {"over the end of the numbers", range(0xFFFFFFFE, 4),
       "4 received, from number 4294967294, 0 lost, 0 doubled, 0 out of order"},
      {"lost over the end of the numbers",
       {0xFFFFFFFE, 1},
       "2 received, from number 4294967294, 2 lost, 0 doubled, 0 out of order"},
  };
  for (const auto& [what, numbers, expected] : rows) {
    EXPECT_EQ(said_of(numbers), "0.10 #7: " + expected) << what;
  }
}

TEST(Checker, ShortMessagesAreCountedOnBeyondWhatTheyHaveRoomFor) {
  EXPECT_EQ(said_of(range(0, 200000), 4),
            "0.10 #7: 200000 received, from number 0, 0 lost, 0 doubled, 0 out of order");
  Numbers numbers = range(0, 70000);
  numbers.erase(numbers.begin() + 65530, numbers.begin() + 65540);
  EXPECT_EQ(said_of(numbers, 4),
            "0.10 #7: 69990 received, from number 0, 10 lost, 0 doubled, 0 out of order");
  EXPECT_EQ(said_of({0, 32767}, 4),
            "0.10 #7: 2 received, from number 0, 32766 lost, 0 doubled, 0 out of order");
}

TEST(Checker, LengthsMayBeMixed) {
  Sequence sequence;
  std::mt19937 random(7);
  for (std::uint32_t number = 65000; number < 67000; ++number) {
    const auto length = static_cast<std::uint8_t>(number == 65000 ? 8 : 4 + random() % 5);
    const auto data = write_numbered({1, false}, number, length);
    sequence.add(*read_numbered({data.data(), length}));
  }
  EXPECT_EQ(sequence.counts().lost + sequence.counts().doubled + sequence.counts().out_of_order,
            0U);
  EXPECT_EQ(sequence.counts().last, 66999U);
}

TEST(Checker, GeneratorsAreToldApart) {
  Checker checker;
  for (std::uint32_t i = 0; i < 10; ++i) {
    checker.add(message({0, 10}, {7, false}, i, 8));
    checker.add(message({0, 10}, {8, false}, 100 + i, 8));
    checker.add(message({0, 11}, {7, false}, 200 + i * 2, 8));
    // One whose source varies has one row of numbers all the same.
    checker.add(message({1, static_cast<std::uint8_t>(i)}, {7, true}, i, 8));
  }
  std::vector<std::string> said;
  for (const Checker::Report& report : checker.reports()) {
    said.push_back(to_string(report));
  }
  EXPECT_EQ(said, (std::vector<std::string>{
                      "any #7: 10 received, from number 0, 0 lost, 0 doubled, 0 out of order",
                      "0.10 #7: 10 received, from number 0, 0 lost, 0 doubled, 0 out of order",
                      "0.10 #8: 10 received, from number 100, 0 lost, 0 doubled, 0 out of order",
                      "0.11 #7: 10 received, from number 200, 9 lost, 0 doubled, 0 out of order",
                  }));
  EXPECT_EQ(checker.total().received, 40U);
  EXPECT_EQ(checker.total().lost, 9U);
  EXPECT_TRUE(checker.failed());
}

TEST(Checker, WhatIsNotNumberedIsNotCountedAmongThem) {
  Checker checker;
  Message other = message({0, 10}, {7, false}, 1, 8);
  other.data[3] ^= 1;
  EXPECT_FALSE(checker.add(other));
  EXPECT_EQ(checker.others(), 1U);
  EXPECT_TRUE(checker.reports().empty());
  EXPECT_FALSE(checker.failed());
}

TEST(Checker, GeneratorsAreBounded) {
  Checker checker;
  for (std::uint32_t i = 0; i < Checker::max_generators + 5; ++i) {
    const Address source{static_cast<std::uint8_t>(i / 128), 3};
    checker.add(message(source, {static_cast<std::uint8_t>(i % 128), false}, 0, 8));
  }
  EXPECT_EQ(checker.reports().size(), Checker::max_generators);
  EXPECT_EQ(checker.others(), 5U);
  EXPECT_TRUE(checker.add(message({0, 3}, {0, false}, 1, 8))) << "those that are known go on";
}

// Against a plain count of what was left out, doubled and moved.
TEST(Checker, AnyDisorderWithinTheWindowIsCountedExactly) {
  const std::uint32_t seed = std::random_device()();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  for (int round = 0; round < 50; ++round) {
    Numbers numbers;
    std::uint64_t lost = 0;
    std::uint64_t doubled = 0;
    for (std::uint32_t number = 0; number < 3000; ++number) {
      const bool is_end = number == 0 || number == 2999;
      const auto dice = is_end ? 99U : static_cast<std::uint32_t>(random() % 100);
      lost += dice < 10 ? 1 : 0;
      doubled += dice >= 10 && dice < 15 ? 1 : 0;
      numbers.insert(numbers.end(), dice < 10 ? 0U : dice < 15 ? 2U : 1U, number);
    }
    Checker checker;
    for (const std::uint32_t number : numbers) {
      checker.add(message({0, 1}, {1, false}, number, 8));
    }
    EXPECT_EQ(checker.total().lost, lost);
    EXPECT_EQ(checker.total().doubled, doubled);
    EXPECT_EQ(checker.total().out_of_order, 0U);
    std::shuffle(numbers.begin() + 1, numbers.end(), random);
    Checker shuffled;
    for (const std::uint32_t number : numbers) {
      shuffled.add(message({0, 1}, {1, false}, number, 8));
    }
    EXPECT_EQ(shuffled.total().lost, lost) << "whatever the order";
    EXPECT_EQ(shuffled.total().doubled, doubled);
  }
}

}  // namespace
}  // namespace roio::cli
