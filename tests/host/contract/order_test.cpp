// Nothing overtakes, nothing is lost, nothing comes twice, as long as the receivers keep up.
#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "contract.hpp"

namespace roio::test {
namespace {

ROIO_CONTRACT(Order);

/// Lets senders run at most `window` frames ahead of the slowest receiver, so that no queue on the
/// way overflows.
class Pace {
 public:
  Pace(std::size_t receivers, std::size_t window) : received_(receivers), window_(window) {}

  void before_sending(std::size_t frames) {
    std::unique_lock lock(mutex_);
    sent_ += frames;
    moved_.wait_for(lock, guard, [this] {
      return sent_ <= *std::min_element(received_.begin(), received_.end()) + window_;
    });
  }
  void received(std::size_t receiver, std::size_t frames) {
    const std::lock_guard lock(mutex_);
    received_.at(receiver) += frames;
    moved_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable moved_;
  std::vector<std::size_t> received_;
  std::size_t sent_ = 0;
  std::size_t window_;
};

constexpr std::size_t window = 128;

void send_paced(Bus& bus, const std::vector<Frame>& frames, std::size_t batch, Pace& pace) {
  for (std::size_t i = 0; i < frames.size(); i += batch) {
    const auto part = std::span(frames).subspan(i, std::min(batch, frames.size() - i));
    pace.before_sending(part.size());
    const Transfer transfer = bus.send(part, guard);
    ASSERT_EQ(transfer.result, Result::ok);
    ASSERT_EQ(transfer.count, part.size());
  }
}

std::vector<Frame> receive_paced(Bus& bus, std::size_t count, std::size_t who, Pace& pace) {
  std::vector<Frame> frames;
  std::array<Received, 32> batch{};
  while (frames.size() < count) {
    const auto room = std::span(batch).first(std::min(batch.size(), count - frames.size()));
    const Transfer transfer = bus.receive(room, guard);
    if (transfer.result != Result::ok) {
      ADD_FAILURE() << frames.size() << " of " << count << ", then " << to_string(transfer.result);
      break;
    }
    for (const Received& received : room.first(transfer.count)) {
      EXPECT_EQ(received.lost_before, 0U);
      frames.push_back(received.frame);
    }
    pace.received(who, transfer.count);
  }
  return frames;
}

/// Frames of one priority, with identifiers and kinds that go up and down: those must not matter.
std::vector<Frame> of_one_priority(std::uint32_t count) {
  std::vector<Frame> frames;
  for (std::uint32_t i = 0; i < count; ++i) {
    Frame frame = numbered(i, 0x10000000 | ((i * 0x00A5A5A7) & 0x0FFFFFFF));
    if (i % 5 == 4) {
      frame.kind = FrameKind::standard;
      frame.id = (i * 0x2B) & 0x7FF;
    }
    frames.push_back(frame);
  }
  return frames;
}

TEST_P(Order, OfOneSenderIsKept) {
  const auto sender = join();
  const auto receiver = join();
  const std::vector<Frame> frames = of_one_priority(4'000);
  Pace pace(1, window);
  auto sending = in_thread([&] { send_paced(*sender, frames, 7, pace); });
  EXPECT_EQ(receive_paced(*receiver, frames.size(), 0, pace), frames);
  result_of(sending);
  expect_silence(*receiver);
}

/// Frames of all kinds and both priorities, as a log of another system's bus has them.
std::vector<Frame> of_both_priorities(std::uint32_t count) {
  std::vector<Frame> frames = of_one_priority(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (frames[i].kind == FrameKind::extended && (i * 0x9E3779B1) >> 31 != 0) {
      frames[i].id &= 0x0FFFFFFF;
    }
  }
  return frames;
}

TEST_P(Order, OfBothPrioritiesIsKeptWhenAskedFor) {
  const auto sender = join({.send_only = true, .in_order = true});
  const auto receiver = join();
  const std::vector<Frame> frames = of_both_priorities(1'000);
  Pace pace(1, window);
  auto sending = in_thread([&] { send_paced(*sender, frames, 50, pace); });
  EXPECT_EQ(receive_paced(*receiver, frames.size(), 0, pace), frames);
  result_of(sending);
  expect_silence(*receiver);
}

std::vector<Frame> from_sender(const std::vector<Frame>& frames, std::uint32_t source) {
  std::vector<Frame> result;
  std::copy_if(frames.begin(), frames.end(), std::back_inserter(result),
               [source](const Frame& frame) { return (frame.id & 0xFF) == source; });
  return result;
}

TEST_P(Order, OfTwoSendersIsKeptForEach) {
  constexpr std::uint32_t count = 2'000;
  const auto sender_a = join();
  const auto sender_b = join();
  const auto receiver = join();
  const auto bystander = join();
  std::vector<Frame> a;
  std::vector<Frame> b;
  for (std::uint32_t i = 0; i < count; ++i) {
    a.push_back(numbered(i, 0x10004001));
    b.push_back(numbered(i, 0x10004002));
  }
  // Each sender hears the other one alone: its own frames count as received from the start.
  Pace pace(4, window);
  pace.received(0, count);
  pace.received(1, count);
  const auto reading = [&pace](Bus& bus, std::size_t expected, std::size_t who) {
    return in_thread(
        [&bus, &pace, expected, who] { return receive_paced(bus, expected, who, pace); });
  };
  auto at_a = reading(*sender_a, count, 0);
  auto at_b = reading(*sender_b, count, 1);
  auto at_receiver = reading(*receiver, std::size_t{2} * count, 2);
  auto at_bystander = reading(*bystander, std::size_t{2} * count, 3);
  auto sending_a = in_thread([&] { send_paced(*sender_a, a, 5, pace); });
  auto sending_b = in_thread([&] { send_paced(*sender_b, b, 3, pace); });
  const std::vector<Frame> seen = result_of(at_receiver);
  const std::vector<Frame> seen_too = result_of(at_bystander);
  EXPECT_EQ(from_sender(seen, 1), a);
  EXPECT_EQ(from_sender(seen, 2), b);
  EXPECT_EQ(from_sender(seen_too, 1), a);
  EXPECT_EQ(from_sender(seen_too, 2), b);
  EXPECT_EQ(result_of(at_a), b);
  EXPECT_EQ(result_of(at_b), a);
  if (GetParam().one_order) {
    EXPECT_EQ(seen, seen_too) << "one bus has one order";
  }
  result_of(sending_a);
  result_of(sending_b);
}

TEST_P(Order, BatchesOfAnySizeAreTakenAsTheyCome) {
  const auto sender = join();
  const auto receiver = join();
  std::vector<Frame> frames;
  for (std::uint32_t i = 0; i < 10; ++i) {
    frames.push_back(numbered(i));
  }
  send_all(*sender, frames);
  std::vector<Frame> seen;
  std::array<Received, 4> batch{};
  while (seen.size() < frames.size()) {
    const Transfer transfer = receiver->receive(batch, guard);
    ASSERT_EQ(transfer.result, Result::ok);
    ASSERT_GE(transfer.count, 1U);
    ASSERT_LE(transfer.count, batch.size());
    for (std::size_t i = 0; i < transfer.count; ++i) {
      seen.push_back(batch.at(i).frame);
    }
  }
  EXPECT_EQ(seen, frames);
}

ROIO_CONTRACT_WHERE(Arbitration, arbitrates);

TEST_P(Arbitration, UrgentPassesNormalOfTheSameSender) {
  const auto sender = join();
  const auto receiver = join();
  std::vector<Frame> frames;
  for (std::uint32_t i = 0; i < 40; ++i) {
    frames.push_back(numbered(i, 0x1000400A));
  }
  frames.push_back(numbered(100, 0x0000400A));
  frames.push_back(numbered(101, 0x0000400A));
  send_all(*sender, frames);
  std::vector<Frame> urgent;
  std::vector<Frame> normal;
  const std::vector<Frame> seen = frames_of(receive_exactly(*receiver, frames.size()));
  for (const Frame& frame : seen) {
    (frame.id == 0x0000400A ? urgent : normal).push_back(frame);
  }
  EXPECT_EQ(urgent, (std::vector{numbered(100, 0x0000400A), numbered(101, 0x0000400A)}));
  EXPECT_EQ(normal, std::vector(frames.begin(), frames.end() - 2));
  EXPECT_EQ(seen.back(), numbered(39)) << "all urgent ones passed the last normal one";
}

TEST_P(Arbitration, TheLowerIdentifiersOfAnotherSenderGoFirst) {
  constexpr std::uint32_t lower = 0x10002001;
  constexpr std::uint32_t count = 30;
  const auto busy = join({.send_only = true});
  const auto other = join({.send_only = true});
  const auto receiver = join();
  const std::vector<Frame> many(20'000, numbered(0, 0x1000400A));  // seconds of bus time
  auto sending = in_thread([&] { return busy->send(many, forever).result; });
  receive_exactly(*receiver, 1);
  std::vector<Frame> few;
  for (std::uint32_t i = 0; i < count; ++i) {
    few.push_back(numbered(i, lower));
  }
  // A sender whose controller runs empty now and then lets the other one in, and so does one whose
  // program this machine keeps waiting. Without arbitration it would be as bad every time.
  const std::size_t most = GetParam().refills_fast ? count * 2 / 3 : count;
  std::size_t fewest = many.size();
  for (int round = 0; round < 8 && fewest >= most; ++round) {
    send_all(*other, few);
    std::vector<Frame> passed;
    std::size_t between = 0;  // frames of the busy sender after the first of the others
    while (passed.size() < count) {
      const Frame frame = receive_exactly(*receiver, 1).at(0).frame;
      if (frame.id == lower) {
        passed.push_back(frame);
      } else if (!passed.empty()) {
        ++between;
      }
    }
    EXPECT_EQ(passed, few);
    fewest = std::min(fewest, between);
  }
  EXPECT_LT(fewest, most) << "taking turns would be one after each";
  busy->cancel();
  EXPECT_EQ(result_of(sending), Result::cancelled) << "it had not come to its end";
}

}  // namespace
}  // namespace roio::test
