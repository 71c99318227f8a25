// Nodes: on every backend, and on a bus that says exactly what a test wants.
#include <algorithm>
#include <array>
#include <deque>
#include <roio/node.hpp>
#include <stdexcept>

#include "contract.hpp"

namespace roio::test {
namespace {

constexpr Address own{0, 2};
constexpr std::array<std::uint8_t, 3> angles{90, 45, 0};

std::vector<std::uint8_t> data_of(const ReceivedMessage& message) {
  return {message.data().begin(), message.data().end()};
}

ROIO_CONTRACT(Nodes);

void expect_message(Node& node, Address source, bool broadcast) {
  ReceivedMessage message{};
  ASSERT_EQ(node.receive(message, guard), Result::ok);
  EXPECT_EQ(message.source(), source);
  EXPECT_EQ(message.is_broadcast(), broadcast);
  EXPECT_EQ(data_of(message), std::vector<std::uint8_t>(angles.begin(), angles.end()));
}

void expect_no_message(Node& node) {
  ReceivedMessage message{};
  EXPECT_EQ(node.receive(message, moment), Result::timeout);
}

TEST_P(Nodes, HearTheirOwnAddressAndTheirSubnet) {
  Node controller(join(), Address{0, 10});
  Node arm(join(), own);
  Node bystander(join(), Address{0, 3});
  Node stranger(join(), Address{1, 2});
  ASSERT_EQ(controller.send(own, angles), Result::ok);
  expect_message(arm, {0, 10}, false);
  expect_no_message(bystander);
  expect_no_message(stranger);

  ASSERT_EQ(arm.send(broadcast_of(0), angles, Priority::urgent), Result::ok);
  expect_message(controller, own, true);
  expect_message(bystander, own, true);
  expect_no_message(stranger);
  expect_no_message(arm);
}

TEST_P(Nodes, HearWhatTheirInterestSays) {
  Node sender(join(), Address{0, 10});
  const ClassSet only_messages = ClassSet::none().with(MessageClass::message);
  Node monitor(join(), Interest{{0, 250}, 0, only_messages, true});
  Node two_subnets(join(), Interest{{1, 2}, (1U << 1) | (1U << 3), ClassSet::all(), false});
  ASSERT_EQ(sender.send({7, 7}, angles), Result::ok);
  ASSERT_EQ(sender.send(broadcast_of(3), angles), Result::ok);
  Message system{{Priority::normal, MessageClass::system, {1, 2}, {}}, 0, {}};
  ASSERT_EQ(sender.send(system), Result::ok);

  expect_message(monitor, {0, 10}, false);
  expect_message(monitor, {0, 10}, true);
  expect_no_message(monitor);
  expect_message(two_subnets, {0, 10}, true);
  ReceivedMessage message{};
  ASSERT_EQ(two_subnets.receive(message, guard), Result::ok);
  EXPECT_EQ(message.message.header,
            (Header{Priority::normal, MessageClass::system, {1, 2}, {0, 10}}))
      << "the source is the sender's own";
  EXPECT_TRUE(data_of(message).empty());
}

TEST_P(Nodes, CountWhatIsNoMessageForThem) {
  const auto raw = join();
  Node node(join(), own);
  send_all(*raw, {{0x0C00400A, FrameKind::extended, 0, {}},  // the reserved class
                  {0x100040FF, FrameKind::extended, 0, {}},  // from the broadcast address
                  {0x1000400A, FrameKind::extended, 1, {7}}});
  ReceivedMessage message{};
  ASSERT_EQ(node.receive(message, guard), Result::ok);
  EXPECT_EQ(data_of(message), std::vector<std::uint8_t>{7});
  EXPECT_EQ(node.counters().unknown_class, 1U);
  EXPECT_EQ(node.counters().invalid_source, 1U);
  EXPECT_EQ(node.counters().foreign, 0U);
}

/// A bus that gives what it is told to give and keeps what it is told to send.
class ScriptedBus final : public Bus {
 public:
  std::deque<Received> incoming;
  std::vector<Frame> outgoing;
  std::vector<SocketCanFilter> filters;
  int begun = 0;  // times that they were set without waiting
  Result when_empty = Result::timeout;

  Transfer send(std::span<const Frame> frames, Timeout) override {
    outgoing.insert(outgoing.end(), frames.begin(), frames.end());
    return {Result::ok, frames.size()};
  }
  Transfer receive(std::span<Received> frames, Timeout) override {
    const std::size_t count = std::min(frames.size(), incoming.size());
    std::copy_n(incoming.begin(), count, frames.begin());
    incoming.erase(incoming.begin(), incoming.begin() + static_cast<std::ptrdiff_t>(count));
    return {count > 0 ? Result::ok : when_empty, count};
  }
  void set_filters(std::span<const SocketCanFilter> given) override {
    filters.assign(given.begin(), given.end());
  }
  void begin_set_filters(std::span<const SocketCanFilter> given) override {
    set_filters(given);
    ++begun;
  }
  [[nodiscard]] int fd() const noexcept override { return -1; }
  [[nodiscard]] int event_fd() const noexcept override { return -1; }
  Events take_events() override { return {}; }
  [[nodiscard]] BusState state() const override { return BusState::active; }
  [[nodiscard]] Statistics statistics() const override { return {}; }
  void cancel() noexcept override {}
  void resume() noexcept override {}
  void close() noexcept override {}
  void begin_close() noexcept override {}
  [[nodiscard]] const std::string& name() const noexcept override { return name_; }

 private:
  std::string name_ = "scripted";
};

struct NodeOnScript {
  NodeOnScript() : NodeOnScript(interest_of(own)) {}
  explicit NodeOnScript(const Interest& interest)
      : NodeOnScript(std::make_unique<ScriptedBus>(), interest) {}

  ScriptedBus& bus;
  Node node;

 private:
  NodeOnScript(std::unique_ptr<ScriptedBus> owned, const Interest& interest)
      : bus(*owned), node(std::move(owned), interest) {}
};

Received received(std::uint32_t id, FrameKind kind = FrameKind::extended,
                  std::uint64_t lost_before = 0) {
  return {{id, kind, 0, {}}, Timestamp(std::chrono::seconds(id & 0xFF)), lost_before};
}

TEST(Node, CountsEachFrameThatIsNoMessageByItsReason) {
  NodeOnScript on;
  on.bus.incoming = {
      received(0x123, FrameKind::standard),
      received(0x123, FrameKind::standard_remote),
      received(0x1000400A, FrameKind::extended_remote),
      received(0x4, FrameKind::error),
      received(0x1C00400A),  // the reserved class
      received(0x100040FF),  // from the broadcast address
      received(0x1000600A),  // to 0.3: a filter let through too much
      received(0x1000400B),
  };
  ReceivedMessage message{};
  ASSERT_EQ(on.node.receive(message, no_wait), Result::ok);
  EXPECT_EQ(message.source(), (Address{0, 11}));
  EXPECT_EQ(message.time, Timestamp(std::chrono::seconds(11)));
  EXPECT_EQ(on.node.counters().foreign, 4U);
  EXPECT_EQ(on.node.counters().unknown_class, 1U);
  EXPECT_EQ(on.node.counters().invalid_source, 1U);
  EXPECT_EQ(on.node.counters().not_wanted, 1U);
}

TEST(Node, TellsLossesWithTheNextMessage) {
  NodeOnScript on;
  on.bus.incoming = {received(0x1000400A, FrameKind::extended, 2),
                     received(0x123, FrameKind::standard, 3),
                     received(0x1000400A, FrameKind::extended, 4), received(0x1000400A)};
  ReceivedMessage message{};
  for (const std::uint64_t lost : {2U, 7U, 0U}) {
    ASSERT_EQ(on.node.receive(message, no_wait), Result::ok);
    EXPECT_EQ(message.lost_before, lost);
  }
}

TEST(Node, TellsWhyThereIsNoMessage) {
  NodeOnScript on;
  for (const Result result : {Result::timeout, Result::cancelled, Result::closed}) {
    on.bus.when_empty = result;
    on.bus.incoming = {received(0x123, FrameKind::standard)};
    ReceivedMessage message{};
    EXPECT_EQ(on.node.receive(message, no_wait), result);
  }
}

TEST(Node, GivesMoreThanABatchInOrder) {
  NodeOnScript on;
  for (std::uint32_t source = 0; source < 100; ++source) {
    on.bus.incoming.push_back(received(0x10004000 + source));
  }
  for (std::uint8_t source = 0; source < 100; ++source) {
    ReceivedMessage message{};
    ASSERT_EQ(on.node.receive(message, no_wait), Result::ok);
    EXPECT_EQ(message.source().node, source);
  }
}

TEST(Node, AsksTheBusForItsInterestAlone) {
  const NodeOnScript on;
  ASSERT_EQ(on.bus.filters.size(), 2U);
  EXPECT_EQ(on.bus.filters[0].can_id, 0x80004000U);
  EXPECT_EQ(on.bus.filters[0].can_mask, 0xC3FFE000U);
  EXPECT_EQ(on.bus.filters[1].can_id, 0x801FE000U);
  EXPECT_EQ(on.bus.filters[1].can_mask, 0xC3FFE000U);
  EXPECT_EQ(on.node.address(), own);
  EXPECT_EQ(on.bus.begun, 0);
}

TEST(Node, NeedNotWaitForItsFilters) {
  auto owned = std::make_unique<ScriptedBus>();
  const ScriptedBus& bus = *owned;
  const Node node(std::move(owned), own, {.background = true});
  EXPECT_EQ(bus.begun, 1);
  EXPECT_EQ(bus.filters.size(), 2U);
}

TEST(Node, SendsFromItsOwnAddress) {
  NodeOnScript on;
  EXPECT_EQ(on.node.send({0, 10}, angles), Result::ok);
  EXPECT_EQ(on.node.send(broadcast_of(31), {}, Priority::urgent), Result::ok);
  const Message stream{{Priority::normal, MessageClass::stream, {1, 1}, {9, 9}}, 1, {5}};
  EXPECT_EQ(on.node.send(stream), Result::ok);
  EXPECT_EQ(on.bus.outgoing, (std::vector<Frame>{{0x10014002, FrameKind::extended, 3, {90, 45, 0}},
                                                 {0x03FFE002, FrameKind::extended, 0, {}},
                                                 {0x18202002, FrameKind::extended, 1, {5}}}));
}

TEST(Node, RefusesToSendWhatNoMessageIs) {
  NodeOnScript on;
  const std::array<std::uint8_t, 9> nine{};
  EXPECT_THROW(static_cast<void>(on.node.send({0, 1}, nine)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(on.node.send({32, 1}, angles)), std::invalid_argument);
  const Message reserved{{Priority::normal, MessageClass::reserved, {0, 1}, {}}, 0, {}};
  EXPECT_THROW(static_cast<void>(on.node.send(reserved)), std::invalid_argument);
  const Message long_one{{Priority::normal, MessageClass::message, {0, 1}, {}}, 9, {}};
  EXPECT_THROW(static_cast<void>(on.node.send(long_one)), std::invalid_argument);
  EXPECT_TRUE(on.bus.outgoing.empty());
}

TEST(Node, RefusesToBeWhatNoNodeIs) {
  const auto make = [](Address address) { return Node(std::make_unique<ScriptedBus>(), address); };
  EXPECT_NO_THROW(make({31, 254}));
  EXPECT_THROW(make({0, 255}), std::invalid_argument);
  EXPECT_THROW(make({32, 0}), std::invalid_argument);
  EXPECT_THROW(Node(nullptr, own), std::invalid_argument);
}

}  // namespace
}  // namespace roio::test
