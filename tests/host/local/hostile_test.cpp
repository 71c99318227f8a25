// Clients that misbehave: the others lose nothing by it.
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <roio.hpp>
#include <thread>

#include "local/log.hpp"
#include "local/place.hpp"
#include "local/presence.hpp"
#include "local/protocol.hpp"
#include "local/slot_filters.hpp"
#include "local/stream.hpp"
#include "process.hpp"

namespace roio::local {
namespace {

using namespace std::chrono_literals;
using test::Peer;
using test::unique_name;

constexpr Frame some_frame{0x1004A00A, FrameKind::extended, 1, {7}};

void send_raw(const ParentsFd& socket, const Buffer& bytes) {
  ASSERT_EQ(::send(socket.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL),
            static_cast<ssize_t>(bytes.size()));
}

// Whether the hub hangs up within a while.
bool is_cut_off(const ParentsFd& socket) {
  std::array<std::uint8_t, 4096> bytes{};
  for (;;) {
    pollfd entry{socket.get(), POLLIN, 0};
    if (::poll(&entry, 1, 30'000) <= 0) {
      return false;
    }
    if (::recv(socket.get(), bytes.data(), bytes.size(), 0) <= 0) {
      return true;
    }
  }
}

constexpr std::uint64_t some_client = 4711;

Buffer hello() {
  Buffer bytes;
  append_record(bytes, Hello{magic, protocol_version, 0, some_client, 0, 0});
  return bytes;
}

class HostileClient : public ::testing::Test {
 protected:
  // After whatever a client did, two others still talk.
  void expect_others_unharmed() {
    ASSERT_EQ(sender_->send(some_frame, 10s), Result::ok);
    Received received{};
    ASSERT_EQ(receiver_->receive(received, 10s), Result::ok);
    EXPECT_EQ(received.frame.id, some_frame.id);
    EXPECT_EQ(received.lost_before, 0U);
    EXPECT_EQ(receiver_->statistics().outages, 0U);
  }

  std::string name_ = unique_name();
  std::unique_ptr<Bus> receiver_ = open("local:" + name_);
  std::unique_ptr<Bus> sender_ = open("local:" + name_, {.send_only = true});
  Place::Hub hub_ = Place(name_).find().value();
  Presence presence_{hub_.lock_path, some_client};
  ParentsFd socket_ = std::move(hub_.socket);
};

TEST_F(HostileClient, GarbageInsteadOfAGreetingIsCutOff) {
  send_raw(socket_, Buffer(300, 0xA5));
  EXPECT_TRUE(is_cut_off(socket_));
  expect_others_unharmed();
}

TEST_F(HostileClient, AFrameBeforeTheGreetingIsCutOff) {
  Buffer bytes;
  append_record(bytes, OfferedFrame{1, normal_lane, 0, to_wire(some_frame)});
  send_raw(socket_, bytes);
  EXPECT_TRUE(is_cut_off(socket_));
  Received received{};
  EXPECT_EQ(receiver_->receive(received, no_wait), Result::timeout) << "and not delivered";
  expect_others_unharmed();
}

TEST_F(HostileClient, GarbageAfterTheGreetingIsCutOff) {
  Buffer bytes = hello();
  bytes.insert(bytes.end(), 50, 0xFF);
  send_raw(socket_, bytes);
  EXPECT_TRUE(is_cut_off(socket_));
  expect_others_unharmed();
}

TEST_F(HostileClient, HalfARecordAndThenNothing) {
  Buffer bytes = hello();
  append_record(bytes, OfferedFrame{1, normal_lane, 0, to_wire(some_frame)});
  bytes.resize(bytes.size() - 5);
  send_raw(socket_, bytes);
  expect_others_unharmed();
}

TEST_F(HostileClient, HalfARecordAndThenGone) {
  Buffer bytes = hello();
  append_record(bytes, OfferedFrame{1, normal_lane, 0, to_wire(some_frame)});
  bytes.resize(bytes.size() - 5);
  send_raw(socket_, bytes);
  socket_.reset();
  expect_others_unharmed();
}

TEST_F(HostileClient, AFrameThatNoBusCarriesIsCutOff) {
  Buffer bytes = hello();
  OfferedFrame offered{1, normal_lane, 0, to_wire(some_frame)};
  offered.frame.length = 9;
  append_record(bytes, offered);
  send_raw(socket_, bytes);
  EXPECT_TRUE(is_cut_off(socket_));
  expect_others_unharmed();
}

TEST_F(HostileClient, AFrameInNoLaneIsCutOff) {
  Buffer bytes = hello();
  append_record(bytes, OfferedFrame{1, lane_count, 0, to_wire(some_frame)});
  send_raw(socket_, bytes);
  EXPECT_TRUE(is_cut_off(socket_));
  expect_others_unharmed();
}

TEST_F(HostileClient, WhoDoesNotShowThatItIsAliveIsCutOff) {
  presence_.end();
  send_raw(socket_, hello());
  EXPECT_TRUE(is_cut_off(socket_));
  expect_others_unharmed();
}

TEST_F(HostileClient, APlaceOutOfRangeHarmsNobodyElse) {
  send_raw(socket_, hello());
  std::array<std::uint8_t, sizeof(RecordHead) + sizeof(Welcome)> answer{};
  UniqueFd wake;
  pollfd entry{socket_.get(), POLLIN, 0};
  ASSERT_EQ(::poll(&entry, 1, 30'000), 1);
  ASSERT_EQ(receive_with_fd(socket_.get(), answer, wake), answer.size());
  std::span<const std::uint8_t> rest = answer;
  Record record{};
  ASSERT_EQ(take_record(rest, record), Split::record);
  const ClientMemory memory(presence_.fd(), record.as<Welcome>().slot);
  Slot& slot = memory.slot();
  publish_filters(slot, std::array{SocketCanFilter{0, 0}});
  for (const std::uint64_t next : {UINT64_C(0), (UINT64_C(1) << 48) - 1}) {
    slot.position = pack({next, 77});
    slot.filter_version = 3;  // for ever changing
    slot.filter_count = 100'000;
    slot.sleeping = 1;
    slot.queued = UINT64_MAX;
    const std::vector<Frame> lot(1000, some_frame);
    for (std::uint64_t sent = 0; sent < log_size + 2000; sent += lot.size()) {
      ASSERT_EQ(sender_->send(lot, 30s).result, Result::ok);
      std::array<Received, 1000> received;
      for (std::size_t got = 0; got < lot.size();) {
        const Transfer transfer = receiver_->receive(received, 30s);
        ASSERT_EQ(transfer.result, Result::ok);
        got += transfer.count;
      }
    }
  }
  expect_others_unharmed();
}

TEST_F(HostileClient, TheHubsOwnRecordsAreCutOff) {
  Buffer bytes = hello();
  append_record(bytes, Refused{0, 0});
  send_raw(socket_, bytes);
  EXPECT_TRUE(is_cut_off(socket_));
  expect_others_unharmed();
}

TEST_F(HostileClient, AnotherVersionIsToldSo) {
  Buffer bytes;
  append_record(bytes, Hello{magic, protocol_version + 1, 0, 4711, 0, 0});
  send_raw(socket_, bytes);
  pollfd entry{socket_.get(), POLLIN, 0};
  ASSERT_EQ(::poll(&entry, 1, 30'000), 1);
  std::array<std::uint8_t, 64> answer{};
  const ssize_t got = ::recv(socket_.get(), answer.data(), answer.size(), 0);
  ASSERT_GT(got, 0);
  std::span<const std::uint8_t> rest = std::span(answer).first(static_cast<std::size_t>(got));
  Record record{};
  ASSERT_EQ(take_record(rest, record), Split::record);
  ASSERT_EQ(record.type, RecordType::refused);
  EXPECT_EQ(record.as<Refused>().errc, static_cast<std::uint32_t>(Errc::version_mismatch));
}

// As many as a bus takes, each by its own number; not as buses, whose threads would be many.
class Crowd {
 public:
  explicit Crowd(std::string name) : name_(std::move(name)) {
    rlimit files{};
    ::getrlimit(RLIMIT_NOFILE, &files);
    files.rlim_cur = std::min<rlim_t>(files.rlim_max, 4096);
    ::setrlimit(RLIMIT_NOFILE, &files);
  }

  // What the hub answers to one more.
  RecordType add() {
    Member member{Place(name_).find().value(), {}};
    const std::uint64_t number = 10'000 + ++count_;
    member.presence = Presence(member.hub.lock_path, number);
    Buffer bytes;
    append_record(bytes, Hello{magic, protocol_version, 0, number, 0, 0});
    send_raw(member.hub.socket, bytes);
    pollfd entry{member.hub.socket.get(), POLLIN, 0};
    EXPECT_EQ(::poll(&entry, 1, 30'000), 1);
    RecordHead head{};
    EXPECT_EQ(::recv(member.hub.socket.get(), &head, sizeof head, 0),
              static_cast<ssize_t>(sizeof head));
    members_.push_back(std::move(member));
    return head.type;
  }
  void drop_one() { members_.erase(members_.begin()); }

 private:
  struct Member {
    Place::Hub hub;
    Presence presence;
  };
  const std::string name_;
  std::uint64_t count_ = 0;
  std::vector<Member> members_;
};

TEST_F(HostileClient, ABusTakesSoManyProgramsAndTellsTheNextOne) {
  Crowd crowd(name_);
  for (std::size_t i = 2; i < max_clients; ++i) {  // two are there
    ASSERT_EQ(crowd.add(), RecordType::welcome) << i;
  }
  EXPECT_EQ(crowd.add(), RecordType::refused);
  try {
    const auto bus = open("local:" + name_);
    ADD_FAILURE() << "opened";
  } catch (const std::system_error& error) {
    EXPECT_EQ(std::string(error.what()),
              "local:" + name_ + ": 256 programs are on the bus, as many as it takes");
  }
  expect_others_unharmed();
  crowd.drop_one();
  EXPECT_NO_THROW(open("local:" + name_)) << "once one has gone";
}

// One process neither reads nor writes, another is stopped altogether; a third keeps all it gets.
TEST_F(HostileClient, NeverReadingCostsTheOthersNothing) {
  Peer holder({"hold", "local:" + name_});
  ASSERT_EQ(holder.line(), "open");
  Peer stopped({"hold", "local:" + name_});
  ASSERT_EQ(stopped.line(), "open");
  stopped.stop();
  constexpr std::uint64_t count = 150'000;  // more than a queue holds
  std::jthread reader([this] {
    std::array<Received, 256> batch;
    std::uint64_t got = 0;
    while (got < count) {
      const Transfer transfer = receiver_->receive(batch, 30s);
      ASSERT_EQ(transfer.result, Result::ok) << "after " << got;
      for (std::size_t i = 0; i < transfer.count; ++i) {
        ASSERT_EQ(batch.at(i).lost_before, 0U);
      }
      got += transfer.count;
    }
  });
  const std::vector<Frame> lot(1000, some_frame);
  for (std::uint64_t sent = 0; sent < count; sent += lot.size()) {
    ASSERT_EQ(sender_->send(lot, 30s).result, Result::ok) << "after " << sent;
  }
  reader.join();
  stopped.signal(SIGCONT);
}

// received + dropped = sent, at any moment and for a reader that starts too late.
TEST_F(HostileClient, WhatAnIdleReaderLosesIsCountedExactly) {
  constexpr std::uint64_t count = 100'000;
  const std::vector<Frame> lot(1000, some_frame);
  for (std::uint64_t sent = 0; sent < count; sent += lot.size()) {
    ASSERT_EQ(sender_->send(lot, 30s).result, Result::ok) << "after " << sent;
  }
  sender_->close();  // all that was sent has left the hub, or been dropped by it
  std::array<Received, 256> batch;
  std::uint64_t received = 0;
  for (;;) {
    const Transfer transfer = receiver_->receive(batch, 1s);
    if (transfer.result != Result::ok) {
      break;
    }
    received += transfer.count;
  }
  const Statistics statistics = receiver_->statistics();
  EXPECT_GE(received, 65'536U) << "as many as are kept for it";
  EXPECT_EQ(statistics.received, received);
  EXPECT_EQ(statistics.received + statistics.dropped, count);
}

}  // namespace
}  // namespace roio::local
