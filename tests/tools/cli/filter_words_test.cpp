#include "listen/filter_words.hpp"

#include "seed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <ostream>
#include <random>
#include <roio/filter_socketcan.hpp>
#include <roio/header.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace roio::cli {
namespace {

using Words = std::vector<std::string>;

Words split(const std::string& text) {
  std::istringstream stream(text);
  Words words;
  for (std::string word; stream >> word;) {
    words.push_back(word);
  }
  return words;
}

// "ID:MASK" with eight digits each, as the kernel gets them.
std::string compiled(const Words& words, bool roio_only = false) {
  const auto filters = compile_filter_words(words, roio_only);
  if (!filters) {
    return filters.error().message;
  }
  std::string text;
  for (const SocketCanFilter& filter : *filters) {
    std::array<char, 24> pair{};
    std::snprintf(pair.data(), pair.size(), "%s%08X:%08X", text.empty() ? "" : " ", filter.can_id,
                  filter.can_mask);
    text += pair.data();
  }
  return text;
}

// Worked by hand from the header's layout, docs/protocol.md: destination subnet 21, node 13; source
// subnet 8, node 0; priority 28, class 26. Bit 31: extended, bit 30: remote, never set.
struct Golden {
  const char* name;
  const char* words;
  const char* filters;
};

std::ostream& operator<<(std::ostream& out, const Golden& row) {
  return out << row.name;
}

class FilterWordsGolden : public testing::TestWithParam<Golden> {};

TEST_P(FilterWordsGolden, Compiles) {
  EXPECT_EQ(compiled(split(GetParam().words)), GetParam().filters);
}

INSTANTIATE_TEST_SUITE_P(
    All, FilterWordsGolden,
    testing::Values(
        Golden{"NoWordsAreEveryFrame", "", "00000000:00000000"},
        Golden{"ToANode", "to=0.2", "80004000:C3FFE000"},
        Golden{"ToTheLastNode", "to=31.254", "83FFC000:C3FFE000"},
        Golden{"ToABroadcast", "to=0.*", "801FE000:C3FFE000"},
        Golden{"ToABroadcastByNumber", "to=0.255", "801FE000:C3FFE000"},
        Golden{"ToAnybodyOfASubnet", "to=1.any", "80200000:C3E00000"},
        Golden{"FromANode", "from=0.3", "80000003:C0001FFF"},
        Golden{"FromAnybodyOfASubnet", "from=1.any", "80000100:C0001F00"},
        Golden{"Urgent", "urgent", "80000000:D0000000"},
        Golden{"Normal", "normal", "90000000:D0000000"},
        Golden{"ClassMessage", "class=message", "80000000:CC000000"},
        Golden{"ClassSystem", "class=system", "84000000:CC000000"},
        Golden{"ClassStream", "class=stream", "88000000:CC000000"},
        Golden{"ClassReservedThatNobodyShouldSend", "class=reserved", "8C000000:CC000000"},
        Golden{"OneKindWidens", "to=0.2 to=0.*", "80004000:C3FFE000 801FE000:C3FFE000"},
        Golden{"KindsNarrow", "to=0.2 urgent", "80004000:D3FFE000"},
        Golden{"OrBeginsAnotherChoice", "to=0.2 or from=0.2",
               "80004000:C3FFE000 80000002:C0001FFF"},
        Golden{"WhatIsInAnotherIsLeftOut", "to=0.2 or to=0.any", "80000000:C3E00000"},
        Golden{"TwiceTheSameIsOnce", "urgent urgent or urgent", "80000000:D0000000"},
        Golden{"CandumpMask", "123:7FF", "00000123:000007FF"},
        Golden{"CandumpMaskAnyCase", "1aB:7fF", "000001AB:000007FF"},
        Golden{"CandumpExtendedByEightDigits", "1004A00A:DFFFFFFF", "9004A00A:DFFFFFFF"},
        Golden{"CandumpExtendedButFlagNotMasked", "1004A00A:1FFFFFFF", "1004A00A:1FFFFFFF"},
        Golden{"CandumpLargest", "7FF:C00007FF 1FFFFFFF:DFFFFFFF",
               "000007FF:C00007FF 9FFFFFFF:DFFFFFFF"},
        Golden{"CandumpRemoteRequestsAlone", "123:7FF 0~40000000", "40000123:400007FF"},
        Golden{"CandumpInverted", "123~7FF", "20000123:000007FF"},
        Golden{"CandumpEverything", "0:0", "00000000:00000000"},
        Golden{"TwoIdentifiersWiden", "1:7FF 2:7FF", "00000001:000007FF 00000002:000007FF"},
        Golden{"TwoExclusionsBothTakeAway", "1~3 2~3", "00000000:00000003 00000003:00000003"}),
    [](const auto& row) { return row.param.name; });

struct Refused {
  const char* name;
  const char* words;
  const char* error;
};

std::ostream& operator<<(std::ostream& out, const Refused& row) {
  return out << row.name;
}

class FilterWordsRefused : public testing::TestWithParam<Refused> {};

TEST_P(FilterWordsRefused, SaysWhatWasExpected) {
  EXPECT_EQ(compiled(split(GetParam().words)), GetParam().error);
}

constexpr const char* expected_hex =
    "expected an identifier and a mask of 1 to 8 hexadecimal digits each, such as 123:7FF or "
    "1004A00A~1FFFFFFF";

INSTANTIATE_TEST_SUITE_P(
    All, FilterWordsRefused,
    testing::Values(
        Refused{"UnknownWord", "urgnet",
                "bad filter \"urgnet\": expected to=SUBNET.NODE, from=SUBNET.NODE, urgent, normal, "
                "class=message|system|stream, ID:MASK, ID~MASK or the word or"},
        Refused{"OrAtTheStart", "or urgent",
                "bad filter \"or\": expected a filter on either side of it"},
        Refused{"OrAtTheEnd", "urgent or",
                "bad filter \"or\": expected a filter on either side of it"},
        Refused{"OrTwice", "urgent or or normal",
                "bad filter \"or\": expected a filter on either side of it"},
        Refused{"Contradiction", "to=0.2 123:C00007FF",
                "no frame can satisfy these filters together; put \"or\" between choices"},
        Refused{"TakesAllAwayAgain", "123:7FF 123~7FF",
                "no frame can satisfy these filters together; put \"or\" between choices"},
        Refused{"StandardIdentifierTooLarge", "800:7FF",
                "bad filter \"800:7FF\": identifier 800 is out of range; expected 0..7FF, or 8 "
                "digits (extended)"},
        Refused{"FourDigitsAreNoExtendedIdentifier", "1234:7FF",
                "bad filter \"1234:7FF\": identifier 1234 is out of range; expected 0..7FF, or 8 "
                "digits (extended)"},
        Refused{"StandardMaskTooLarge", "123:7FF0",
                "bad filter \"123:7FF0\": mask 7FF0 is out of range; expected 0..7FF beside an "
                "identifier below 8 digits, plus 80000000 and 40000000 for the kind of frame"},
        Refused{
            "StandardMaskOfAnExtendedIdentifier", "123~1FFFFFFF",
            "bad filter \"123~1FFFFFFF\": mask 1FFFFFFF is out of range; expected 0..7FF beside "
            "an identifier below 8 digits, plus 80000000 and 40000000 for the kind of frame"},
        Refused{"ExtendedIdentifierTooLarge", "FFFFFFFF:FFFFFFFF",
                "bad filter \"FFFFFFFF:FFFFFFFF\": identifier FFFFFFFF is out of range; expected "
                "00000000..1FFFFFFF"},
        Refused{"ErrorReportsAreNotFilteredByMask", "1FFFFFFF:3FFFFFFF",
                "bad filter \"1FFFFFFF:3FFFFFFF\": mask 3FFFFFFF is out of range; expected "
                "0..1FFFFFFF, plus 80000000 and 40000000 for the kind of frame"},
        Refused{"NobodySendsFromABroadcastAddress", "from=3.*",
                "bad filter \"from=3.*\": \"3.*\" is the broadcast address, which nobody sends "
                "from; expected 3.any for any node of the subnet"},
        Refused{"NorByItsNumber", "from=3.255",
                "bad filter \"from=3.255\": \"3.255\" is the broadcast address, which nobody sends "
                "from; expected 3.any for any node of the subnet"}),
    [](const auto& row) { return row.param.name; });

TEST(FilterWords, RefusesWhatIsNoIdentifierAndMask) {
  for (const char* word : {":", "123:", ":7FF", "12G:7FF", "123:7FFx", "123456789:7FF", "123:-1",
                           "0x123:7FF", "123:7FF:7FF", "123~", "~7FF", "to:0.2", "123: 7FF"}) {
    EXPECT_EQ(compiled({word}), "bad filter \"" + std::string(word) + "\": " + expected_hex);
  }
}

TEST(FilterWords, NamesTheWordAndWhatIsWrongWithItsAddress) {
  for (const char* word : {"to=", "to=0", "to=32.1", "to=0.256", "from=0.x", "to=.any", "to=32.any",
                           "from=0.any.any", "to=0.2,urgent", "class=", "class=fast"}) {
    const auto filters = compile_filter_words(Words{word});
    ASSERT_FALSE(filters.ok()) << word;
    const std::string begin = "bad filter \"" + std::string(word) + "\": ";
    EXPECT_EQ(filters.error().message.substr(0, begin.size()), begin);
    EXPECT_NE(filters.error().message.find("expected"), std::string::npos)
        << filters.error().message;
  }
}

TEST(FilterWords, RefusesMoreThanABusTakesAndTakesExactlyAsMany) {
  Words words;
  for (unsigned id = 0; id < max_kernel_filters; ++id) {
    words.push_back(std::string(1, "0123456789ABCDEF"[id >> 8]) +
                    std::string(1, "0123456789ABCDEF"[(id >> 4) & 0xF]) +
                    std::string(1, "0123456789ABCDEF"[id & 0xF]) + ":7FF");
  }
  const auto filters = compile_filter_words(words);
  ASSERT_TRUE(filters.ok()) << filters.error().message;
  EXPECT_EQ(filters->size(), max_kernel_filters);
  words.emplace_back("7FF:7FF");
  EXPECT_EQ(compiled(words),
            "these filters are too many: they come to more than 512 (identifier, mask) pairs; "
            "expected fewer words");
}

TEST(FilterWords, RefusesExclusionsThatMultiplyBeyondMeasure) {
  EXPECT_EQ(compiled({"00000000~1FFFFFFF", "0AAAAAAA~1FFFFFFF", "05555555~1FFFFFFF"}),
            "these filters are too many: they come to more than 512 (identifier, mask) pairs; "
            "expected fewer words");
}

TEST(FilterWords, RoioOnlyLeavesOutEveryOtherKindOfFrame) {
  EXPECT_EQ(compiled({}, true), "80000000:C0000000");
  EXPECT_EQ(compiled({"to=0.2"}, true), "80004000:C3FFE000");
  EXPECT_EQ(compiled({"3:3"}, true), "80000003:C0000003");
  EXPECT_EQ(compiled({"3~3"}, true), "80000000:C0000001 80000000:C0000002");
}

// --- the property: compiled filters accept exactly the frames that the words mean ---------------

// A frame, taken apart by plain shifts, so that nothing is shared with what is tested.
struct Seen {
  explicit Seen(std::uint32_t tagged)
      : roio((tagged >> 30) == 2),
        urgent(((tagged >> 28) & 1) == 0),
        message_class((tagged >> 26) & 3),
        to_subnet((tagged >> 21) & 31),
        to_node((tagged >> 13) & 255),
        from_subnet((tagged >> 8) & 31),
        from_node(tagged & 255),
        raw(tagged) {}
  bool roio, urgent;
  unsigned message_class, to_subnet, to_node, from_subnet, from_node;
  std::uint32_t raw;
};

using Meaning = std::function<bool(const Seen&)>;

struct Term {
  enum Kind { to, from, priority, message_class, identifier, exclusion } kind;
  std::string word;
  Meaning meaning;
};

class RandomWords {
 public:
  explicit RandomWords(std::mt19937 random) : random_(random) {}

  // Subnets and nodes are few, so that random frames often meet them.
  unsigned subnet() { return pick({0, 1, 31}); }
  unsigned node() { return pick({0, 2, 10, 254}); }
  unsigned up_to(unsigned last) { return test::up_to(random_, last); }
  unsigned pick(const std::vector<unsigned>& choices) {
    return choices[up_to(static_cast<unsigned>(choices.size()) - 1)];
  }

  std::uint32_t tagged() {
    const unsigned form = up_to(3);
    if (form == 0) {
      return pick({0, 0x40000000}) | pick({0x123, 0x124, 0x7FF, up_to(0x7FF)});
    }
    if (form == 1) {
      return pick({0x80000000, 0xC0000000}) | up_to(0x1FFFFFFF);
    }
    return 0x80000000U | up_to(1) << 28 | up_to(3) << 26 | subnet() << 21 |
           pick({node(), 255}) << 13 | subnet() << 8 | pick({node(), 255});
  }

  Term term() {
    switch (up_to(5)) {
      case 0:
        return to();
      case 1:
        return from();
      case 2: {
        const bool urgent = up_to(1) == 0;
        return {Term::priority, urgent ? "urgent" : "normal",
                [=](const Seen& f) { return f.roio && f.urgent == urgent; }};
      }
      case 3: {
        const unsigned c = up_to(3);
        return {Term::message_class,
                std::string("class=") + std::array{"message", "system", "stream", "reserved"}[c],
                [=](const Seen& f) { return f.roio && f.message_class == c; }};
      }
      case 4:
        return identifier(':');
      default:
        return identifier('~');
    }
  }

 private:
  Term to() {
    const unsigned s = subnet();
    const std::string begin = "to=" + std::to_string(s) + ".";
    switch (up_to(2)) {
      case 0:
        return {Term::to, begin + "*",
                [=](const Seen& f) { return f.roio && f.to_subnet == s && f.to_node == 255; }};
      case 1:
        return {Term::to, begin + "any", [=](const Seen& f) { return f.roio && f.to_subnet == s; }};
      default:
        const unsigned n = node();
        return {Term::to, begin + std::to_string(n),
                [=](const Seen& f) { return f.roio && f.to_subnet == s && f.to_node == n; }};
    }
  }
  Term from() {
    const unsigned s = subnet();
    const std::string begin = "from=" + std::to_string(s) + ".";
    if (up_to(1) == 0) {
      return {Term::from, begin + "any",
              [=](const Seen& f) { return f.roio && f.from_subnet == s; }};
    }
    const unsigned n = node();
    return {Term::from, begin + std::to_string(n),
            [=](const Seen& f) { return f.roio && f.from_subnet == s && f.from_node == n; }};
  }
  Term identifier(char sign) {
    const bool extended = up_to(1) == 0;
    const std::uint32_t id = extended ? tagged() & 0x1FFFFFFF : pick({0x123, 0x124, up_to(0x7FF)});
    const std::uint32_t all = extended ? 0x1FFFFFFF : 0x7FF;
    const std::uint32_t mask =
        pick({0x7FF, 0xC00007FF, all, 0xC0000000 | all, 0x3, 0x80000000, up_to(0x7FF)});
    std::array<char, 24> word{};
    std::snprintf(word.data(), word.size(), extended ? "%08X%c%X" : "%03X%c%X", id, sign, mask);
    const std::uint32_t wanted = id | (extended ? 0x80000000U : 0U);
    const bool taken_away = sign == '~';
    return {taken_away ? Term::exclusion : Term::identifier, word.data(),
            [=](const Seen& f) { return ((f.raw & mask) == (wanted & mask)) != taken_away; }};
  }

  std::mt19937 random_;
};

// What docs/cli.md says: within a choice, kinds narrow and words of one kind widen; every exclusion
// takes away.
bool means(const std::vector<Term>& choice, const Seen& frame) {
  for (const Term& term : choice) {
    const auto same_kind_accepts = [&](const Term& other) {
      return other.kind == term.kind && other.meaning(frame);
    };
    const bool accepted = term.kind == Term::exclusion
                              ? term.meaning(frame)
                              : std::any_of(choice.begin(), choice.end(), same_kind_accepts);
    if (!accepted) {
      return false;
    }
  }
  return true;
}

std::vector<std::vector<Term>> random_choices(RandomWords& random) {
  std::vector<std::vector<Term>> choices(1 + random.up_to(1));
  for (auto& choice : choices) {
    int exclusions = 0;
    for (unsigned i = 0, count = 1 + random.up_to(3); i < count; ++i) {
      const Term term = random.term();
      if (term.kind != Term::exclusion || exclusions++ == 0) {
        choice.push_back(term);
      }
    }
  }
  return choices;
}

Words words_of(const std::vector<std::vector<Term>>& choices) {
  Words words;
  for (const auto& choice : choices) {
    if (!words.empty()) {
      words.emplace_back("or");
    }
    for (const Term& term : choice) {
      words.push_back(term.word);
    }
  }
  return words;
}

TEST(FilterWords, AcceptExactlyTheFramesThatTheyMean) {
  RandomWords random(test::seeded_generator());
  unsigned accepted_frames = 0;
  for (int round = 0; round < 2000; ++round) {
    const auto choices = random_choices(random);
    const bool roio_only = random.up_to(3) == 0;
    const Words words = words_of(choices);
    const auto filters = compile_filter_words(words, roio_only);
    for (int i = 0; i < 100; ++i) {
      const Seen frame(random.tagged());
      const bool meant = (frame.roio || !roio_only) &&
                         std::any_of(choices.begin(), choices.end(),
                                     [&](const auto& choice) { return means(choice, frame); });
      const bool accepted = filters.ok() && std::any_of(filters->begin(), filters->end(),
                                                        [&](const SocketCanFilter& filter) {
                                                          return accepts(filter, frame.raw);
                                                        });
      accepted_frames += accepted ? 1U : 0U;
      ASSERT_EQ(accepted, meant) << std::hex << frame.raw << " by " << testing::PrintToString(words)
                                 << (roio_only ? " roio only: " : ": ")
                                 << compiled(words, roio_only);
    }
  }
  EXPECT_GT(accepted_frames, 2000U) << "the random frames never met the random words";
}

}  // namespace
}  // namespace roio::cli
