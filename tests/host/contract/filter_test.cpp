// What a bus lets through to its receiver.
#include <array>
#include <roio/error.hpp>
#include <roio/filter.hpp>
#include <system_error>

#include "contract.hpp"

namespace roio::test {
namespace {

ROIO_CONTRACT(Filters);

constexpr std::uint32_t extended_flag = socketcan::extended_flag;
constexpr std::uint32_t remote_flag = socketcan::remote_flag;
constexpr std::uint32_t inverted = socketcan::inverted;

/// Of descending precedence, so that every backend keeps their order.
constexpr std::array<Frame, 7> probes{{
    {0x123, FrameKind::standard, 1, {1}},
    {0x123, FrameKind::standard_remote, 0, {}},
    {0x124, FrameKind::standard, 1, {2}},
    {0x1000400A, FrameKind::extended, 1, {3}},
    {0x1000400A, FrameKind::extended_remote, 0, {}},
    {0x1000600A, FrameKind::extended, 1, {4}},
    {0x1BFFFFFE, FrameKind::extended, 1, {5}},
}};

struct FilterCase {
  const char* why;
  std::vector<SocketCanFilter> filters;
  std::vector<std::size_t> passing;  ///< Indices of the probes.
};

const FilterCase filter_cases[] = {
    {"everything", {{0, 0}}, {0, 1, 2, 3, 4, 5, 6}},
    {"nothing", {}, {}},
    {"one standard identifier, data only", {{0x123, extended_flag | remote_flag | 0x7FF}}, {0}},
    {"one standard identifier, remote too", {{0x123, extended_flag | 0x7FF}}, {0, 1}},
    {"standard frames", {{0, extended_flag}}, {0, 1, 2}},
    {"a standard filter compares 11 bits", {{0x12345123, extended_flag | 0x1FFFFFFF}}, {0, 1}},
    {"extended data frames", {{extended_flag, extended_flag | remote_flag}}, {3, 5, 6}},
    {"remote frames", {{remote_flag, remote_flag}}, {1, 4}},
    {"one destination", {to_socketcan({0x00004000, 0x03FFE000, FilterMeaning::own_address})}, {3}},
    {"the highest and the lowest bit of the identifier",
     {{extended_flag | 0x10000000, extended_flag | 0x10000001}},
     {3, 4, 5, 6}},
    {"all but one", {{inverted | 0x123, extended_flag | remote_flag | 0x7FF}}, {1, 2, 3, 4, 5, 6}},
    {"inverted everything is nothing", {{inverted, 0}}, {}},
    {"a frame that two filters accept comes once",
     {{0, 0}, {0x123, 0x7FF}, {extended_flag, extended_flag}},
     {0, 1, 2, 3, 4, 5, 6}},
    {"either of two",
     {{0x124, extended_flag | 0x7FF}, {extended_flag | 0x1BFFFFFE, extended_flag | 0x1FFFFFFF}},
     {2, 6}},
};

void expect_passing(Bus& receiver, Bus& sender, const FilterCase& row) {
  SCOPED_TRACE(row.why);
  send_all(sender, {probes.begin(), probes.end()});
  std::vector<Frame> expected;
  for (const std::size_t index : row.passing) {
    expected.push_back(probes.at(index));
  }
  EXPECT_EQ(frames_of(receive_exactly(receiver, expected.size())), expected);
  expect_silence(receiver);
}

TEST_P(Filters, LetThroughWhatTheyAccept) {
  const auto sender = join();
  for (const FilterCase& row : filter_cases) {
    const auto receiver = join();
    receiver->set_filters(row.filters);
    expect_passing(*receiver, *sender, row);
  }
}

TEST_P(Filters, ChangeWhileTheBusIsOpen) {
  const auto sender = join();
  const auto receiver = join();
  for (const FilterCase& row : filter_cases) {
    receiver->set_filters(row.filters);
    expect_passing(*receiver, *sender, row);
  }
}

TEST_P(Filters, AreEachReceiversOwn) {
  const auto sender = join();
  const auto choosy = join();
  const auto bystander = join();
  choosy->set_filters({});
  sender->set_filters({});
  send_all(*sender, {numbered(1)});
  EXPECT_EQ(frames_of(receive_exactly(*bystander, 1)), std::vector{numbered(1)});
  expect_silence(*choosy);
}

TEST_P(Filters, WhatTheyKeepAwayIsNotCounted) {
  const auto sender = join();
  const auto receiver = join();
  receiver->set_filters(std::array{SocketCanFilter{0x124, extended_flag | 0x7FF}});
  send_all(*sender, {probes.begin(), probes.end()});
  receive_exactly(*receiver, 1);
  EXPECT_EQ(receiver->statistics().received, 1U);
  EXPECT_EQ(receiver->statistics().dropped, 0U);
}

TEST_P(Filters, FiveHundredAndTwelveAreTakenAndOneMoreIsNot) {
  const auto sender = join();
  const auto receiver = join();
  std::vector<SocketCanFilter> filters(512, {0x124, extended_flag | 0x7FF});
  filters.back() = {0x123, extended_flag | 0x7FF};
  receiver->set_filters(filters);
  filters.push_back({0, 0});
  try {
    receiver->set_filters(filters);
    ADD_FAILURE() << "513 filters taken";
  } catch (const std::system_error& error) {
    EXPECT_EQ(error.code(), make_error_code(Errc::too_many_filters)) << error.what();
  }
  expect_passing(*receiver, *sender, {"the 512 are still there", {}, {0, 1, 2}});
}

TEST_P(Filters, ASendOnlyBusReceivesOnceItHasFilters) {
  const auto peer = join();
  const auto bus = join({.send_only = true});
  send_all(*bus, {numbered(1)});
  EXPECT_EQ(frames_of(receive_exactly(*peer, 1)), std::vector{numbered(1)});
  const auto witness = join();
  send_all(*peer, {numbered(2)});
  EXPECT_EQ(frames_of(receive_exactly(*witness, 1)), std::vector{numbered(2)}) << "it has passed";
  expect_silence(*bus);
  bus->set_filters(std::array{SocketCanFilter{0, 0}});
  send_all(*peer, {numbered(3)});
  EXPECT_EQ(frames_of(receive_exactly(*bus, 1)), std::vector{numbered(3)});
}

}  // namespace
}  // namespace roio::test
