// What a DBC can tell apart on one identifier, and who sends what to whom.
#include "kind/ways.hpp"

#include <gtest/gtest.h>

namespace roio::cli {
namespace {

using Names = std::vector<std::string>;

MessageKind message(const char* name, std::uint8_t length, std::optional<std::uint8_t> tag = {}) {
  MessageKind made;
  made.name = name;
  made.tag = tag;
  made.min_length = length;
  made.max_length = length;
  return made;
}

Names names_of(const std::vector<const MessageKind*>& messages) {
  Names names;
  for (const MessageKind* each : messages) {
    names.push_back(each->name);
  }
  return names;
}

struct Row {
  const char* why;
  std::vector<MessageKind> messages;
  Names told;
  Names untold;
};

TEST(Ways, WhatADbcTellsApart) {
  const Row rows[] = {
      {"one", {message("a", 3)}, {"a"}, {}},
      {"one with a tag", {message("a", 3, 1)}, {"a"}, {}},
      {"empty ones beside it hold nothing to misread",
       {message("a", 3), message("e", 0)},
       {"a"},
       {}},
      {"two lengths", {message("a", 3), message("b", 2)}, {}, {"a", "b"}},
      {"two tags", {message("a", 3, 1), message("b", 3, 2)}, {"a", "b"}, {}},
      {"two tags, two lengths", {message("a", 3, 1), message("b", 5, 2)}, {"a", "b"}, {}},
      {"one tag, two lengths", {message("a", 3, 1), message("b", 2, 1)}, {}, {"a", "b"}},
      {"one tag twice, and another",
       {message("a", 3, 1), message("b", 2, 1), message("c", 2, 7)},
       {"c"},
       {"a", "b"}},
      {"a tag, and none in another length", {message("a", 3, 1), message("b", 2)}, {}, {"a", "b"}},
      {"a tag alone in its byte", {message("a", 1, 1), message("b", 3, 2)}, {"a", "b"}, {}},
  };
  for (const Row& row : rows) {
    SCOPED_TRACE(row.why);
    std::vector<const MessageKind*> all;
    for (const MessageKind& each : row.messages) {
      all.push_back(&each);
    }
    const Distinction found = distinguish(all);
    EXPECT_EQ(names_of(found.told), row.told);
    EXPECT_EQ(names_of(found.untold), row.untold);
  }
}

class RobotOf {
 public:
  RobotOf& with(const char* name, Address address, std::shared_ptr<const Kind> kind = nullptr) {
    Place place;
    place.name = name;
    place.address = address;
    place.kind = std::move(kind);
    robot.places.push_back(std::move(place));
    return *this;
  }
  Robot robot;
};

std::shared_ptr<const Kind> kind(std::vector<MessageKind> heard, std::vector<MessageKind> said) {
  Kind made;
  made.heard = std::move(heard);
  made.said = std::move(said);
  return std::make_shared<const Kind>(made);
}

Names text_of(const Robot& robot) {
  Names lines;
  for (const Way& way : ways_of(robot)) {
    std::string line = way.source->name + '>' + robot.name_of(way.header().destination);
    for (const MessageKind* each : way.messages) {
      line += ' ' + each->name;
    }
    lines.push_back(line);
  }
  return lines;
}

TEST(Ways, WithoutAKindWhatTheReceiverHears) {
  const Robot robot = RobotOf()
                          .with("pc", {0, 10})
                          .with("arm", {0, 2}, kind({message("move", 3), message("ask", 0)}, {}))
                          .robot;
  EXPECT_EQ(text_of(robot), (Names{"pc>arm move ask", "pc>0.* move ask"}));
}

TEST(Ways, WithAKindWhatThatSaysAlone) {
  const auto arm = kind({message("move", 3)}, {message("moved", 1)});
  const Robot robot = RobotOf().with("left", {0, 2}, arm).with("right", {1, 2}, arm).robot;
  EXPECT_EQ(text_of(robot), (Names{"left>right moved", "left>0.* moved", "left>1.* moved",
                                   "right>left moved", "right>0.* moved", "right>1.* moved"}));
}

TEST(Ways, WithAKindThatSaysNothingWhatTheReceiverHears) {
  const Robot robot = RobotOf()
                          .with("panel", {0, 10}, kind({message("light", 1)}, {}))
                          .with("arm", {0, 2}, kind({message("move", 3)}, {}))
                          .robot;
  EXPECT_EQ(text_of(robot),
            (Names{"panel>arm move", "panel>0.* move", "arm>panel light", "arm>0.* light"}));
}

TEST(Ways, ToEverybodyWhereAllThatKnowItAgree) {
  const Robot robot = RobotOf()
                          .with("pc", {0, 10})
                          .with("a", {0, 1}, kind({message("x", 3), message("only-a", 4)}, {}))
                          .with("b", {0, 2}, kind({message("y", 3)}, {}))
                          .robot;
  EXPECT_EQ(text_of(robot), (Names{"pc>a x only-a", "pc>b y", "pc>0.* only-a", "a>b y", "a>0.* y",
                                   "b>a x only-a", "b>0.* x only-a"}));
}

TEST(Ways, ToEverybodyWhatTwoKindsHaveAlikeOnce) {
  const Robot robot = RobotOf()
                          .with("pc", {0, 10})
                          .with("a", {0, 1}, kind({message("stop", 2)}, {}))
                          .with("b", {0, 2}, kind({message("stop", 2), message("b", 5)}, {}))
                          .robot;
  EXPECT_EQ(text_of(robot), (Names{"pc>a stop", "pc>b stop b", "pc>0.* stop b", "a>b stop b",
                                   "a>0.* stop b", "b>a stop", "b>0.* stop"}));
}

TEST(Ways, NobodyToTalkTo) {
  EXPECT_EQ(text_of(RobotOf().with("pc", {0, 10}).with("panel", {0, 11}).robot), Names{});
  EXPECT_EQ(text_of(Robot{}), Names{});
}

}  // namespace
}  // namespace roio::cli
