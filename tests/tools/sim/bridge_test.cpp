// The bridge between the simulated bus and another one, which here takes and gives as a test says.
#include "bridge.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <roio/sim/can_bus.hpp>
#include <vector>

#include "program/exit_status.hpp"

namespace roio::sim_tool {
namespace {

using namespace std::chrono_literals;
constexpr std::uint32_t rate = 500'000;

Frame frame(std::uint32_t number) {
  return {0x1000'0000U | number, FrameKind::extended, 1, {static_cast<std::uint8_t>(number)}};
}

class OtherBus final : public Bus {
 public:
  std::deque<Frame> offered;    // to the bridge
  std::vector<Frame> taken;     // from the bridge
  std::size_t room = SIZE_MAX;  // of taken

  Transfer send(std::span<const Frame> frames, Timeout timeout) override {
    EXPECT_EQ(timeout, no_wait);
    const std::size_t count = std::min(frames.size(), room - taken.size());
    taken.insert(taken.end(), frames.begin(), frames.begin() + static_cast<std::ptrdiff_t>(count));
    return {count == frames.size() ? Result::ok : Result::timeout, count};
  }
  Transfer receive(std::span<Received> frames, Timeout timeout) override {
    EXPECT_EQ(timeout, no_wait);
    const std::size_t count = std::min(frames.size(), offered.size());
    for (Received& received : frames.first(count)) {
      received = {offered.front(), {}, 0};
      offered.pop_front();
    }
    return {count > 0 ? Result::ok : Result::timeout, count};
  }
  void set_filters(std::span<const SocketCanFilter> /*filters*/) override {}
  void begin_set_filters(std::span<const SocketCanFilter> /*filters*/) override {}
  [[nodiscard]] int fd() const noexcept override { return 77; }
  [[nodiscard]] int event_fd() const noexcept override { return -1; }
  Events take_events() override { return {}; }
  [[nodiscard]] BusState state() const override { return BusState::active; }
  [[nodiscard]] Statistics statistics() const override { return {.dropped = 3}; }
  void cancel() noexcept override {}
  void resume() noexcept override {}
  void close() noexcept override {}
  void begin_close() noexcept override {}
  [[nodiscard]] const std::string& name() const noexcept override { return name_; }

 private:
  std::string name_ = "local:other";
};

class BridgeTest : public testing::Test {
 protected:
  sim::CanBus bus_;
  OtherBus* other_ = new OtherBus;
  Bridge bridge_{bus_, rate, std::unique_ptr<Bus>(other_)};
  sim::HostNode board_{bus_, rate};
};

TEST_F(BridgeTest, TakesNoMoreThanItsNodeSendsInAMoment) {
  for (std::uint32_t i = 0; i < 200; ++i) {
    other_->offered.push_back(frame(i));
  }
  for (int i = 0; i < 10; ++i) {
    bridge_.take();
  }
  EXPECT_EQ(bridge_.taken(), 32U);
  EXPECT_EQ(bridge_.fd(), -1) << "nothing can be taken: polling would not wait";
  bus_.run_for(1ms);
  EXPECT_EQ(bridge_.fd(), 77);
}

TEST_F(BridgeTest, FramesPassWholeAndInOrderAsFastAsTheBusGoes) {
  std::vector<std::uint32_t> seen;
  board_.on_receive([&](const Frame& received) { seen.push_back(received.id & 0xFFFU); });
  for (std::uint32_t i = 0; i < 1000; ++i) {
    other_->offered.push_back(frame(i));
  }
  while (!other_->offered.empty() || bus_.now() < 100ms) {
    bridge_.take();
    bus_.run_for(1ms);
  }
  bus_.run_for(10ms);
  ASSERT_EQ(seen.size(), 1000U);
  for (std::uint32_t i = 0; i < 1000; ++i) {
    EXPECT_EQ(seen[i], i);
  }
  EXPECT_EQ(bridge_.lost(), 3U);
  EXPECT_EQ(other_->taken.size(), 0U) << "what came from there does not go back";
}

TEST_F(BridgeTest, WhenTheOtherBusIsFullTimeIsToWait) {
  other_->room = 100;
  for (std::uint32_t i = 0; i < 400; ++i) {
    board_.send(frame(i));
  }
  while (board_.waiting() > 0) {
    EXPECT_FALSE(bridge_.is_blocked() && bus_.now() < 20ms);
    bus_.run_for(1ms);
    bridge_.give({});
  }
  EXPECT_TRUE(bridge_.is_blocked());
  EXPECT_EQ(bridge_.given(), 100U);
  EXPECT_EQ(bridge_.lost(), 303U) << "300 are still here";
  other_->room = SIZE_MAX;
  bridge_.give({});
  EXPECT_FALSE(bridge_.is_blocked());
  ASSERT_EQ(other_->taken.size(), 400U);
  for (std::uint32_t i = 0; i < 400; ++i) {
    EXPECT_EQ(other_->taken[i].id, 0x1000'0000U | i);
  }
  EXPECT_EQ(bridge_.lost(), 3U);
}

TEST_F(BridgeTest, KindsPassAndALongDlcIsEightBytes) {
  const std::vector<Frame> sent{{0x123, FrameKind::standard, 2, {1, 2}},
                                {0x124, FrameKind::standard_remote, 5, {}},
                                {0x1000'0001, FrameKind::extended_remote, 0, {}},
                                {0x1000'0002, FrameKind::extended, 15, {1, 2, 3, 4, 5, 6, 7, 8}}};
  for (const Frame& one : sent) {
    board_.send(one);
  }
  bus_.run_for(10ms);
  bridge_.give({});
  ASSERT_EQ(other_->taken.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(other_->taken[i].kind, sent[i].kind);
    EXPECT_EQ(other_->taken[i].id, sent[i].id);
    EXPECT_EQ(other_->taken[i].length, std::min<std::uint8_t>(sent[i].length, 8));
  }
}

class BridgeToABusThatIsStuck : public BridgeTest {
 protected:
  BridgeToABusThatIsStuck() { other_->room = 0; }
  void send(std::uint32_t number) {
    board_.send(frame(number));
    bus_.run_for(2ms);
  }
  // The time goes on, in steps shorter than the pauses that count no further.
  void give_for(Bridge::Clock::duration time) {
    for (const auto end = now_ + time; now_ < end;) {
      now_ += 50ms;
      bridge_.give(now_);
    }
  }
  Bridge::Clock::time_point now_{};
};

TEST_F(BridgeToABusThatIsStuck, GivesUpAfterFiveSeconds) {
  give_for(10s);  // nothing waits: nothing is stuck
  send(1);
  give_for(5s);
  try {
    give_for(50ms);
    ADD_FAILURE() << "it goes on";
  } catch (const cli::Failure& failure) {
    EXPECT_STREQ(failure.what(), "local:other: has taken no frame for too long");
  }
}

TEST_F(BridgeToABusThatIsStuck, EveryFrameThatItTakesStartsTheTimeAnew) {
  send(1);
  send(2);
  give_for(5s);
  other_->room = 1;
  give_for(50ms);
  EXPECT_EQ(bridge_.given(), 1U);
  EXPECT_NO_THROW(give_for(5s));
  EXPECT_THROW(give_for(50ms), cli::Failure);
}

TEST_F(BridgeToABusThatIsStuck, APauseOfThisProcessIsNotTheBuss) {
  send(1);
  give_for(50ms);
  now_ += 1h;  // stopped, and continued
  EXPECT_NO_THROW(bridge_.give(now_));
  EXPECT_NO_THROW(give_for(4900ms));
  EXPECT_THROW(give_for(50ms), cli::Failure);
}

TEST(BridgeToNothing, AcknowledgesWhatBoardsSend) {
  sim::CanBus bus;
  const Bridge bridge(bus, rate, nullptr);
  sim::HostNode board(bus, rate);
  board.send(frame(1));
  bus.run_for(2ms);
  EXPECT_EQ(board.waiting(), 0U);
  EXPECT_EQ(bridge.fd(), -1);
  EXPECT_EQ(bridge.lost(), 0U);
}

}  // namespace
}  // namespace roio::sim_tool
