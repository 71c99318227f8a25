// Forwarder: what it hands on, in which order, and what it counts as lost where.
#include "attach/forward.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <deque>
#include <functional>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace roio::cli {
namespace {

using std::chrono::milliseconds;

constexpr Timeout send_time = std::chrono::seconds(1);

/// A bus that a test holds both ends of: it gives the frames it was given, numbered, and takes as
/// many as it has room for.
class FakeBus final : public Bus {
 public:
  using Bus::receive;
  using Bus::send;

  Transfer send(std::span<const Frame> frames, Timeout timeout) override {
    const std::lock_guard lock(mutex_);
    if (broken_) {
      throw std::runtime_error("broken");
    }
    const std::size_t count = std::min(frames.size(), room_);
    room_ -= count;
    // What it has no room for is offered again as long as it takes some.
    settled_ += count > 0 ? count : frames.size();
    timeouts_.push_back(timeout);
    taken_.insert(taken_.end(), frames.begin(),
                  frames.begin() + static_cast<std::ptrdiff_t>(count));
    statistics_.sent += count;
    return {count == frames.size() ? Result::ok : Result::timeout, count};
  }

  Transfer receive(std::span<Received> frames, Timeout /*timeout*/) override {
    std::this_thread::sleep_for(milliseconds(1));
    const std::lock_guard lock(mutex_);
    const std::size_t count = std::min(frames.size(), waiting_.size());
    for (std::size_t i = 0; i < count; ++i) {
      frames[i] = {waiting_.front(), {}, 0};
      waiting_.pop_front();
    }
    const Result none = cancelled_ ? Result::cancelled : Result::timeout;
    return {count > 0 ? Result::ok : none, count};
  }

  void give(std::uint32_t count) {
    const std::lock_guard lock(mutex_);
    for (; count > 0; --count) {
      Frame frame{};
      frame.kind = FrameKind::extended;
      frame.id = next_id_++;
      waiting_.push_back(frame);
    }
  }

  void set_room(std::size_t frames) {
    const std::lock_guard lock(mutex_);
    room_ = frames;
  }
  void set_losses(const Statistics& losses) {
    const std::lock_guard lock(mutex_);
    statistics_ = losses;
  }
  void breaks() {
    const std::lock_guard lock(mutex_);
    broken_ = true;
  }
  [[nodiscard]] std::size_t settled() const {
    const std::lock_guard lock(mutex_);
    return settled_;
  }
  [[nodiscard]] std::vector<Frame> taken() const {
    const std::lock_guard lock(mutex_);
    return taken_;
  }
  [[nodiscard]] std::vector<Timeout> timeouts() const {
    const std::lock_guard lock(mutex_);
    return timeouts_;
  }

  void set_filters(std::span<const SocketCanFilter> /*filters*/) override {}
  void begin_set_filters(std::span<const SocketCanFilter> /*filters*/) override {}
  [[nodiscard]] int fd() const noexcept override { return -1; }
  [[nodiscard]] int event_fd() const noexcept override { return -1; }
  Events take_events() override { return {}; }
  [[nodiscard]] BusState state() const override { return BusState::active; }
  [[nodiscard]] Statistics statistics() const override {
    const std::lock_guard lock(mutex_);
    return statistics_;
  }
  void cancel() noexcept override { cancelled_ = true; }
  void resume() noexcept override { cancelled_ = false; }
  void close() noexcept override {}
  void begin_close() noexcept override {}
  [[nodiscard]] const std::string& name() const noexcept override { return name_; }

 private:
  mutable std::mutex mutex_;
  std::deque<Frame> waiting_;
  std::uint32_t next_id_ = 0;
  std::size_t room_ = SIZE_MAX;
  std::size_t settled_ = 0;
  bool broken_ = false;
  std::vector<Frame> taken_;
  std::vector<Timeout> timeouts_;
  Statistics statistics_;
  std::atomic<bool> cancelled_{false};
  std::string name_ = "fake";
};

class ForwarderTest : public testing::Test {
 protected:
  void wait_until(const std::function<bool()>& it_is_so) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!it_is_so() && !forwarder_.failed()) {
      ASSERT_LT(std::chrono::steady_clock::now(), deadline) << "waited in vain";
      std::this_thread::sleep_for(milliseconds(1));
    }
  }

  /// Gives frames, and waits until each has been taken by the far side, or given up.
  void forward(std::uint32_t count) {
    const std::size_t settled = far_.settled() + count;
    near_.give(count);
    wait_until([&] { return far_.settled() == settled; });
  }

  /// Ends it as its user does.
  std::string end() {
    near_.cancel();
    far_.cancel();
    forwarder_.stop();
    forwarder_.rethrow();
    return forwarder_.report();
  }

  FakeBus near_;
  FakeBus far_;
  Forwarder forwarder_{{near_, "near"}, {far_, "far"}};
};

TEST_F(ForwarderTest, HandsOnEveryFrameInOrder) {
  forward(1000);
  EXPECT_EQ(end(), "near to far: 1000 frames, 0 lost");
  const std::vector<Frame> taken = far_.taken();
  ASSERT_EQ(taken.size(), 1000U);
  for (std::uint32_t i = 0; i < 1000; ++i) {
    ASSERT_EQ(taken[i].id, i);
  }
}

TEST_F(ForwarderTest, CountsWhatTheFarSideDidNotTake) {
  far_.set_room(7);
  forward(10);
  EXPECT_EQ(end(), "near to far: 7 frames, 3 lost (3 not taken by far)");
}

TEST_F(ForwarderTest, WaitsOnceForAFarSideThatIsNotThereAndAgainWhenItIsBack) {
  const std::vector<Timeout> expected{send_time, no_wait, no_wait, send_time};
  far_.set_room(0);
  forward(1);
  forward(1);
  far_.set_room(SIZE_MAX);
  forward(1);
  forward(1);
  EXPECT_EQ(end(), "near to far: 2 frames, 2 lost (2 not taken by far)");
  EXPECT_EQ(far_.timeouts(), expected);
}

TEST_F(ForwarderTest, NamesEveryPlaceOfALoss) {
  near_.set_losses({.dropped = 1, .overruns = 1});
  far_.set_losses({.unsent = 3});
  far_.set_room(8);
  forward(10);
  EXPECT_EQ(end(),
            "near to far: 5 frames, 6 lost (1 on the way from near, 2 not taken by far, 3 not sent "
            "by far); the controller of near lost others, uncounted, 1 time");
}

TEST_F(ForwarderTest, TellsOfFramesThatCannotBeHandedOn) {
  near_.set_losses({.fd_frames = 12});
  EXPECT_EQ(end(), "near to far: 0 frames, 0 lost; 12 CAN FD frames of near not handed on");
}

TEST_F(ForwarderTest, EndsWithWhatABusThrew) {
  far_.breaks();
  near_.give(1);
  wait_until([this] { return forwarder_.failed(); });
  EXPECT_THROW(end(), std::runtime_error);
}

}  // namespace
}  // namespace roio::cli
