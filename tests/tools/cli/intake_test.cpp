// Intake: the order of what comes from several buses, and that none waits for another for ever.
#include "listen/intake.hpp"

#include <gtest/gtest.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace roio::cli {
namespace {

using std::chrono::seconds;

/// A bus that gives the frames it was given, or one after another without an end; each has the
/// second of its time as its identifier.
class FakeBus final : public Bus {
 public:
  using Bus::receive;
  using Bus::send;

  ~FakeBus() override { ::close(fd_); }

  Transfer send(std::span<const Frame> /*frames*/, Timeout /*timeout*/) override {
    return {Result::timeout, 0};
  }
  Transfer receive(std::span<Received> frames, Timeout /*timeout*/) override {
    std::size_t count = 0;
    while (count < frames.size() && (endless_ || !waiting_.empty())) {
      const std::uint32_t second = endless_ ? *endless_ : waiting_.front();
      if (!endless_) {
        waiting_.pop_front();
      }
      Frame frame{};
      frame.id = second;
      frames[count++] = {frame, Timestamp(seconds(second)), 0};
    }
    return {count > 0 ? Result::ok : Result::timeout, count};
  }

  void give(std::vector<std::uint32_t> at) {
    waiting_.insert(waiting_.end(), at.begin(), at.end());
  }
  void give_without_end(std::uint32_t second) { endless_ = second; }

  void set_filters(std::span<const SocketCanFilter> /*filters*/) override {}
  void begin_set_filters(std::span<const SocketCanFilter> /*filters*/) override {}
  [[nodiscard]] int fd() const noexcept override { return fd_; }
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
  int fd_ = ::eventfd(1, EFD_CLOEXEC);  // always readable
  std::deque<std::uint32_t> waiting_;
  std::optional<std::uint32_t> endless_;
  std::string name_ = "fake";
};

class IntakeTest : public testing::Test {
 protected:
  static constexpr std::size_t most = 256;

  IntakeTest() {
    for (FakeBus*& bus : fakes_) {
      auto made = std::make_unique<FakeBus>();
      bus = made.get();
      buses_.push_back(std::move(made));
    }
    intake_.emplace(buses_);
  }

  /// The seconds of what was heard.
  [[nodiscard]] std::vector<std::uint32_t> heard() const {
    std::vector<std::uint32_t> all;
    for (const Heard& heard : intake_->heard()) {
      all.push_back(heard.received->frame.id);
    }
    return all;
  }

  [[nodiscard]] bool has_heard(std::size_t bus) const {
    for (const Heard& heard : intake_->heard()) {
      if (heard.from == bus) {
        return true;
      }
    }
    return false;
  }

  Interrupt interrupt_;
  std::array<FakeBus*, 2> fakes_{};
  std::vector<std::unique_ptr<Bus>> buses_;
  std::optional<Intake> intake_;
};

TEST_F(IntakeTest, WhatComesFromSeveralIsInTheOrderOfTheTimes) {
  fakes_[0]->give({1, 3, 5});
  fakes_[1]->give({2, 4, 6});
  std::vector<std::uint32_t> all;
  while (all.size() < 6) {
    static_cast<void>(intake_->receive(most, seconds(60)));
    const auto more = heard();
    all.insert(all.end(), more.begin(), more.end());
  }
  EXPECT_EQ(all, (std::vector<std::uint32_t>{1, 2, 3, 4, 5, 6}));
}

TEST_F(IntakeTest, AClockThatWasSetBackStarvesNoBus) {
  fakes_[0]->give_without_end(1);
  fakes_[1]->give({2});
  const auto deadline = std::chrono::steady_clock::now() + seconds(20);
  do {
    ASSERT_LT(std::chrono::steady_clock::now(), deadline) << "waited in vain";
    static_cast<void>(intake_->receive(most, seconds(60)));
  } while (!has_heard(1));
}

TEST_F(IntakeTest, WhatIsTakenAtTheEndIsNotHeldBackForOthers) {
  fakes_[1]->give({7});
  intake_->take(most);
  EXPECT_EQ(heard(), std::vector<std::uint32_t>{7});
  intake_->take(most);
  EXPECT_TRUE(heard().empty());
}

TEST_F(IntakeTest, NoMoreIsTakenThanWanted) {
  fakes_[0]->give({1, 2, 3});
  intake_->take(2);
  EXPECT_EQ(heard(), (std::vector<std::uint32_t>{1, 2}));
  intake_->take(2);
  EXPECT_EQ(heard(), std::vector<std::uint32_t>{3});
}

}  // namespace
}  // namespace roio::cli
