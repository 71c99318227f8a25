// KeyReader: what the bytes of a terminal mean, in whatever pieces they come.
#include "top/keys.hpp"

#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <vector>

namespace roio::cli {
namespace {

const std::vector<std::tuple<const char*, std::string, std::vector<Action>>> rows{
    {"letters", "qsrc", {Action::quit, Action::sort, Action::reverse, Action::clear}},
    {"pause and help have two", "p h?", {Action::pause, Action::pause, Action::help, Action::help}},
    {"arrows", "\033[A\033[B", {Action::line_up, Action::line_down}},
    {"arrows in application mode", "\033OA\033OB", {Action::line_up, Action::line_down}},
    {"pages", "\033[5~\033[6~", {Action::page_up, Action::page_down}},
    {"Home and End, three ways",
     "\033[H\033[F\033[1~\033[4~\033OH\033[8~",
     {Action::to_first, Action::to_last, Action::to_first, Action::to_last, Action::to_first,
      Action::to_last}},
    {"with Ctrl", "\033[1;5B", {Action::line_down}},
    {"a key that means nothing is passed over whole", "\033[15~\033[2~x", {}},
    {"Escape alone, then q", "\033\033[Aq", {Action::line_up, Action::quit}},
    {"a sequence that never ends", "\033[" + std::string(1000, '1') + "~", {}},
    {"other bytes", std::string("\0\xFF\x1A\n", 4), {}},
};

TEST(KeyReader, WhatBytesMeanWholeAndInPieces) {
  for (const auto& [what, bytes, expected] : rows) {
    EXPECT_EQ(KeyReader().feed(bytes), expected) << what;
    KeyReader reader;
    std::vector<Action> actions;
    for (const char byte : bytes) {
      for (const Action action : reader.feed(std::string(1, byte))) {
        actions.push_back(action);
      }
    }
    EXPECT_EQ(actions, expected) << what << ", byte by byte";
  }
}

}  // namespace
}  // namespace roio::cli
