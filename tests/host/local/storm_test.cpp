// The hub goes again and again, gracefully and by force, while senders pour, others come to send a
// little and go, and three listen: every frame arrives once and in order at each of the three, or
// is told as lost.
#include <gtest/gtest.h>

#include <csignal>
#include <roio.hpp>
#include <thread>

#include "local/place.hpp"
#include "process.hpp"
#include "seed.hpp"
#include "soak.hpp"

namespace roio {
namespace {

using namespace std::chrono_literals;
using test::Peer;
using test::unique_name;

class Storm : public ::testing::TestWithParam<int> {
 protected:
  using Peers = std::vector<std::unique_ptr<Peer>>;

  std::unique_ptr<Peer> start(const std::vector<std::string>& words) {
    auto peer = std::make_unique<Peer>(words);
    EXPECT_EQ(peer->line(), "open");
    return peer;
  }

  // Which of those that may carry the bus does.
  std::size_t carrier() {
    const local::Place place(name_);
    for (const auto end = std::chrono::steady_clock::now() + 30s;
         std::chrono::steady_clock::now() < end; std::this_thread::sleep_for(100us)) {
      const auto hub = place.find();
      for (std::size_t i = 0; hub && i < holders_.size(); ++i) {
        if (holders_.at(i)->pid() == hub->process) {
          return i;
        }
      }
    }
    ADD_FAILURE() << "nobody carries the bus";
    return 0;
  }

  void end_carrier() {
    std::unique_ptr<Peer>& hub = holders_.at(carrier());
    if (GetParam() == SIGKILL) {
      hub->kill();
    } else {
      hub->tell("");
      EXPECT_EQ(hub->line(), "(end)");
    }
    hub = start({"hold", url_});
  }

  std::uint64_t sent_by(Peer& sender) {
    std::uint64_t sent = 0;
    std::uint64_t unsent = 0;
    const std::string line = sender.line();
    EXPECT_EQ(std::sscanf(line.c_str(), "sent=%lu unsent=%lu", &sent, &unsent), 2) << line;
    EXPECT_EQ(unsent, 0U) << line;
    return sent;
  }

  const std::string name_ = unique_name();
  const std::string url_ = "local:" + name_;
  Peers holders_;
};
INSTANTIATE_TEST_SUITE_P(Hubs, Storm, ::testing::Values(SIGTERM, SIGKILL),
                         [](const auto& how) { return how.param == SIGKILL ? "Killed" : "Ended"; });

TEST_P(Storm, NothingIsLostOrDoubledInSilence) {
  const int changes = test::is_soak() ? 1000 : 30;
  std::mt19937 random = test::seeded_generator();
  holders_.push_back(start({"hold", url_}));
  holders_.push_back(start({"hold", url_}));
  Peers listeners;
  for (int i = 0; i < 3; ++i) {
    listeners.push_back(start({"listen", url_}));
  }
  Peers pouring;
  for (int sender = 1; sender <= 2; ++sender) {
    pouring.push_back(start({"pour", url_, std::to_string(sender)}));
  }
  std::uint64_t sent = 0;
  int shots = 0;
  for (int change = 0; change < changes; ++change) {
    Peers newcomers;
    for (std::uint32_t i = test::up_to(random, 2); i > 0; --i) {
      newcomers.push_back(std::make_unique<Peer>(
          std::vector<std::string>{"shot", url_, std::to_string(100 + shots++)}));
    }
    std::this_thread::sleep_for(std::chrono::microseconds(test::up_to(random, 3000)));
    end_carrier();
    for (const auto& newcomer : newcomers) {
      EXPECT_EQ(newcomer->line(), "open");
      sent += sent_by(*newcomer);
    }
  }
  for (const auto& sender : pouring) {
    sender->tell("");
    sent += sent_by(*sender);
  }
  for (const auto& listener : listeners) {
    listener->tell(std::to_string(sent));
  }
  for (const auto& listener : listeners) {
    const std::string line = listener->line();
    std::uint64_t received = 0;
    std::uint64_t lost = 0;
    std::uint64_t missing = 0;
    std::uint64_t wrong = 0;
    ASSERT_EQ(std::sscanf(line.c_str(), "received=%lu lost=%lu missing=%lu wrong=%lu", &received,
                          &lost, &missing, &wrong),
              4)
        << line;
    EXPECT_EQ(received + lost, sent) << line;
    EXPECT_LE(missing, lost) << line << ": a sender's last ones are told, and not seen missing";
    EXPECT_EQ(wrong, 0U) << line;
    std::cout << line << " of " << sent << "\n";
  }
}

}  // namespace
}  // namespace roio
