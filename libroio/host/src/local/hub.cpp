#include "local/hub.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <roio/error.hpp>
#include <roio/parts/thread.hpp>
#include <utility>

namespace roio::local {
namespace {

constexpr std::size_t max_clients = 256;
// One client's bytes a round; the others get their turn after that.
constexpr int reads_per_round = 16;
constexpr std::size_t frames_per_round = 4096;
// What a client that comes over from another hub can still be given: some 3 MB, and several seconds
// of a saturated 1 Mbit/s bus.
constexpr std::size_t history_limit = queue_limit;
constexpr std::uint32_t window_unpaced = 4096;
// What waits behind a bit rate waits long: about as many frames as a controller and its driver
// hold.
constexpr std::uint32_t window_paced = 64;
constexpr std::chrono::milliseconds check_interval{20};  // while somebody is waited for
constexpr std::chrono::seconds idle_interval{1};         // to see an overdue greeting
constexpr std::chrono::milliseconds finish_time{200};
constexpr std::chrono::milliseconds accept_pause{100};

}  // namespace

Hub::Hub(HubSeat seat, std::optional<std::uint32_t> bitrate_bps)
    : seat_(std::move(seat)),
      medium_(bitrate_bps),
      now_(Clock::now()),
      thread_(start_thread([this] { run(); })) {}

Hub::~Hub() {
  stop_.set();
  thread_.join();
}

std::uint32_t Hub::window() const {
  return medium_.bitrate_bps() ? window_paced : window_unpaced;
}

void Hub::run() {
  while (!stop_.is_set()) {
    wait();
    now_ = Clock::now();
    wall_offset_ns_ = std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch() -
                                               now_.time_since_epoch())
                          .count();
    accept_clients();
    read_clients();
    note_listeners();
    transmit();
    flush_clients();
    report_done();
    drop_closed_clients();
  }
  finish();
}

void Hub::wait() {
  std::vector<pollfd> entries;
  entries.reserve(clients_.size() + 2);
  entries.push_back({stop_.fd(), POLLIN, 0});
  entries.push_back({may_accept() ? seat_.listener() : -1, POLLIN, 0});
  for (const auto& client : clients_) {
    const int events = client->stream().flushed() ? POLLIN : POLLIN | POLLOUT;
    entries.push_back({client->stream().fd(), static_cast<short>(events), 0});
  }
  const auto timeout = time_to_wait();
  const timespec spec{static_cast<time_t>(timeout.count() / 1'000'000'000),
                      static_cast<long>(timeout.count() % 1'000'000'000)};
  // A failed poll (a signal, no memory) is just an early wake-up.
  static_cast<void>(::ppoll(entries.data(), entries.size(), &spec, nullptr));
}

std::chrono::nanoseconds Hub::time_to_wait() const {
  std::chrono::nanoseconds timeout = leaving_.empty() ? std::chrono::nanoseconds(idle_interval)
                                                      : std::chrono::nanoseconds(check_interval);
  if (const auto end = medium_.next_end()) {
    timeout = std::min(timeout, std::chrono::nanoseconds(*end - Clock::now()));
  } else if (medium_.contended()) {
    timeout = must_hold() ? std::chrono::nanoseconds(check_interval) : std::chrono::nanoseconds(0);
  }
  return std::max(timeout, std::chrono::nanoseconds(0));
}

bool Hub::may_accept() const {
  return clients_.size() < max_clients && now_ >= accept_again_;
}

void Hub::accept_clients() {
  while (may_accept()) {
    UniqueFd socket(::accept4(seat_.listener(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (!socket) {
      if (errno != EAGAIN) {
        accept_again_ = now_ + accept_pause;  // out of descriptors: they do not come back by asking
      }
      return;
    }
    if (is_same_user(socket.get())) {
      clients_.push_back(std::make_unique<HubClient>(std::move(socket), now_));
    }
  }
}

void Hub::read_clients() {
  for (const auto& client : clients_) {
    Stream& stream = client->stream();
    for (int i = 0; i < reads_per_round && stream.open(); ++i) {
      const Stream::Read read = stream.read();
      if (read == Stream::Read::nothing) {
        break;
      }
      if (read == Stream::Read::end) {
        stream.close();
        break;
      }
      Record record{};
      Split split = Split::incomplete;
      while (stream.open() && (split = stream.take(record)) == Split::record) {
        handle(*client, record);
      }
      if (split == Split::malformed) {
        stream.close();
      }
    }
    if (client->greeting_overdue(now_)) {
      stream.close();
    }
  }
  medium_.asked_all(now_);
}

void Hub::handle(HubClient& client, const Record& record) {
  if (client.greeted() == (record.type == RecordType::hello)) {
    client.stream().close();
    return;
  }
  switch (record.type) {
    case RecordType::hello:
      greet(client, record.as<Hello>());
      break;
    case RecordType::filters:
      client.set_filters(filters_of(record));
      if (client.take_replay_due()) {
        replay(client);
      }
      break;
    case RecordType::frame:
      take_frame(client, record.as<OfferedFrame>());
      break;
    case RecordType::consumed:
      if (!client.consumed(record.as<Consumed>().count, now_)) {
        client.stream().close();
      }
      break;
    default:
      client.stream().close();
      break;
  }
}

void Hub::greet(HubClient& client, const Hello& hello) {
  const std::uint32_t bitrate = medium_.bitrate_bps().value_or(0);
  if (hello.magic != magic) {
    client.stream().close();
  } else if (hello.version != protocol_version) {
    client.refuse({static_cast<std::uint32_t>(Errc::version_mismatch), bitrate});
  } else if (hello.bitrate_bps != 0 && hello.bitrate_bps != bitrate) {
    client.refuse({static_cast<std::uint32_t>(Errc::bitrate_mismatch), bitrate});
  } else {
    try {
      auto station = std::make_shared<Station>(hello.client);
      client.welcome(station, hello.rejoining != 0, Welcome{bitrate, window()}, listeners());
      medium_.attach(std::move(station));
    } catch (const std::system_error&) {
      client.stream().close();  // it will ask again, and see its own error if this goes on
    }
  }
}

void Hub::take_frame(HubClient& client, const OfferedFrame& offered) {
  const std::optional<Frame> frame = from_wire(offered.frame);
  // A client of ours stays within its window; what does not is no client of ours.
  if (!frame || client.station()->waiting(lane_of(*frame)) > window()) {
    client.stream().close();
    return;
  }
  client.station()->add(lane_of(*frame), {*frame, offered.sequence});
}

std::uint64_t Hub::listeners() const {
  return static_cast<std::uint64_t>(std::count_if(
      clients_.begin(), clients_.end(), [](const auto& client) { return client->listens(); }));
}

// Before anything is carried: who then looks knows of all who were to have it.
void Hub::note_listeners() {
  const std::uint64_t all = listeners();
  for (const auto& client : clients_) {
    client->note_listeners(all - (client->listens() ? 1 : 0));
  }
}

bool Hub::must_hold() const {
  return !medium_.bitrate_bps() && std::any_of(clients_.begin(), clients_.end(),
                                               [this](auto& c) { return c->holds_bus(now_); });
}

void Hub::transmit() {
  for (std::size_t i = 0; i < frames_per_round && !must_hold(); ++i) {
    const auto transmission = medium_.next(now_);
    if (!transmission) {
      return;
    }
    fan_out(*transmission);
  }
}

void Hub::fan_out(const Medium::Transmission& transmission) {
  const auto& [from, offer, lane, end] = transmission;
  ++bus_number_;
  const std::uint32_t tagged = tagged_id(offer.frame);
  const std::int64_t time_ns =
      std::chrono::nanoseconds(end.time_since_epoch()).count() + wall_offset_ns_;
  const Deliver deliver{0, from->sender(), offer.sequence, time_ns, to_wire(offer.frame)};
  HubClient* sender = nullptr;
  bool is_heard = false;
  for (const auto& client : clients_) {
    if (!client->greeted()) {
      continue;
    }
    if (client->station() == from) {
      sender = client.get();
      continue;
    }
    is_heard = is_heard || client->listens();
    if (client->wants(tagged)) {
      client->deliver(deliver, bus_number_, now_);
    }
  }
  if (!is_heard && sender != nullptr) {
    sender->note_unheard();
  }
  if (history_.size() == history_limit) {
    history_.pop_front();
  }
  history_.push_back(deliver);
  leaving_.push_back({bus_number_, from, lane, offer.sequence});
}

// A client that comes over late would miss what was carried before it came; what it had from the
// last hub it leaves out itself.
void Hub::replay(HubClient& client) {
  if (client.listens()) {
    for (const auto& other : clients_) {
      other->forget_unheard();
    }
  }
  client.drop(bus_number_ - history_.size());
  std::uint64_t number = bus_number_ - history_.size();
  for (const Deliver& deliver : history_) {
    ++number;
    if (deliver.sender != client.station()->sender() && client.wants(deliver.frame.tagged_id)) {
      client.deliver(deliver, number, now_);
    }
  }
}

void Hub::flush_clients() {
  for (const auto& client : clients_) {
    if (client->stream().open() && !client->flush(now_)) {
      client->stream().close();
    }
  }
}

void Hub::report_done() {
  const bool paced = medium_.bitrate_bps().has_value();
  std::uint64_t limit = bus_number_;
  for (const auto& client : clients_) {
    if (client->stream().open() && client->holds_done(now_, paced)) {
      limit = std::min(limit, *client->first_unflushed() - 1);
    }
  }
  done_number_ = std::max(done_number_, limit);
  // Before any sender hears of it: killed between the two, the hub has counted too much, not too
  // little.
  for (const auto& client : clients_) {
    client->note_risk(done_number_);
  }
  while (!leaving_.empty() && leaving_.front().number <= limit) {
    const Leaving& frame = leaving_.front();
    const auto owner = std::find_if(clients_.begin(), clients_.end(), [&](const auto& client) {
      return client->station() == frame.from;
    });
    if (owner != clients_.end()) {
      (*owner)->report_done(frame.lane, frame.sequence);
    }
    leaving_.pop_front();
  }
  for (const auto& client : clients_) {
    client->append_done();
  }
  flush_clients();
}

void Hub::drop_closed_clients() {
  std::erase_if(clients_, [this](const std::unique_ptr<HubClient>& client) {
    if (client->stream().open()) {
      return false;
    }
    if (client->greeted()) {
      medium_.detach(client->station());
    }
    return true;
  });
}

// What has been fanned out is passed on, as far as its readers take it in time.
void Hub::finish() {
  const auto end = Clock::now() + finish_time;
  for (now_ = Clock::now(); now_ < end; now_ = Clock::now()) {
    flush_clients();
    report_done();
    drop_closed_clients();
    const bool flushed = std::all_of(clients_.begin(), clients_.end(),
                                     [](auto& client) { return client->stream().flushed(); });
    if (leaving_.empty() && flushed) {
      return;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace roio::local
