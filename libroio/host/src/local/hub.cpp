#include "local/hub.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <new>
#include <roio/error.hpp>
#include <roio/parts/thread.hpp>
#include <utility>

#include "local/presence.hpp"

namespace roio::local {
namespace {

// Some may be connected and not have said who they are, or be told that there is no room.
constexpr std::size_t max_connections = max_clients + 16;
// One client's bytes a round; the others get their turn after that.
constexpr int reads_per_round = 16;
constexpr std::size_t frames_per_round = 4096;
constexpr std::uint32_t window_unpaced = 4096;
// What waits behind a bit rate waits long: about as many frames as a controller and its driver
// hold.
constexpr std::uint32_t window_paced = 64;
constexpr std::chrono::milliseconds hold_interval{20};  // a reader that is waited for may not tell
// To see who never greeted, who died while he was away, and whether the bus is where it was.
constexpr std::chrono::milliseconds look_interval{500};
constexpr std::chrono::milliseconds accept_pause{100};

std::optional<std::uint32_t> rate(std::uint32_t bitrate_bps) {
  return bitrate_bps == 0 ? std::nullopt : std::optional(bitrate_bps);
}

}  // namespace

Hub::Hub(HubSeat seat, std::optional<std::uint32_t> bitrate_bps, std::uint64_t host)
    : seat_(std::move(seat)),
      memory_(seat_.lock_fd()),
      readers_(*memory_),
      roster_(*memory_, seat_.lock_fd(), readers_),
      now_(Clock::now()) {
  if (!memory_.is_set_up() || !roster_.take_over()) {
    memory_.set_up(bitrate_bps.value_or(0));
  }
  memory_->header.hubs.fetch_add(1, std::memory_order_relaxed);
  memory_->header.process.store(::getpid(), std::memory_order_relaxed);
  if (host != 0) {
    memory_->header.host.store(host, std::memory_order_relaxed);
  }
  medium_.emplace(rate(memory_->header.bitrate_bps.load(std::memory_order_relaxed)));
  poller_.add(stop_.fd(), &stop_);
  seat_.open();
  poller_.add(seat_.listener(), &seat_);
  thread_ = start_thread([this] { run(); });
}

Hub::~Hub() {
  stop_.set();
  thread_.join();
}

std::uint32_t Hub::window() const {
  return medium_->bitrate_bps() ? window_paced : window_unpaced;
}

// Without memory it cannot go on; what it had is with the others, and one of them may.
void Hub::run() {
  try {
    while (!stop_.is_set() && !is_over_) {
      serve();
    }
  } catch (const std::bad_alloc&) {
    failed_ = true;
  } catch (const std::system_error&) {
    failed_ = true;
  }
  leave();
}

void Hub::serve() {
  wait();
  if (now_ >= look_again_) {
    look_after_everybody();
  }
  transmit();
  drop_closed_clients();
}

void Hub::wait() {
  if (const bool accepts = may_accept(); std::exchange(accepting_, accepts) != accepts) {
    if (accepts) {
      poller_.add(seat_.listener(), &seat_);
    } else {
      poller_.remove(seat_.listener());
    }
  }
  const std::span<void* const> ready = poller_.wait(time_to_wait());
  now_ = Clock::now();
  wall_offset_ns_ = std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch() -
                                             now_.time_since_epoch())
                        .count();
  for (void* const tag : ready) {
    if (tag == &seat_) {
      accept_clients();
    } else if (tag != &stop_) {
      read(*static_cast<HubClient*>(tag));
    }
  }
}

std::chrono::nanoseconds Hub::time_to_wait() const {
  std::chrono::nanoseconds timeout = look_again_ - Clock::now();
  if (!accepting_) {
    timeout = std::min(timeout, std::chrono::nanoseconds(accept_pause));
  }
  if (const auto end = medium_->next_end()) {
    timeout = std::min(timeout, std::chrono::nanoseconds(*end - Clock::now()));
  } else if (medium_->contended()) {
    timeout = holding_ ? std::min(timeout, std::chrono::nanoseconds(hold_interval))
                       : std::chrono::nanoseconds(0);
  }
  return std::max(timeout, std::chrono::nanoseconds(0));
}

void Hub::look_after_everybody() {
  look_again_ = now_ + look_interval;
  is_over_ = is_over_ || !seat_.is_in_place();
  for (const auto& client : clients_) {
    if (client->greeting_overdue(now_)) {
      cut(*client);
    }
  }
  free_slots_of_the_dead();
}

// A closed descriptor would stay in the poller if a child of this process had it, too.
void Hub::cut(HubClient& client) noexcept {
  if (client.stream().open()) {
    poller_.remove(client.stream().fd());
    client.stream().close();
  }
}

bool Hub::may_accept() const {
  return clients_.size() < max_connections && now_ >= accept_again_;
}

void Hub::accept_clients() {
  while (may_accept()) {
    auto socket = ParentsFd::of([this] {
      return UniqueFd(::accept4(seat_.listener(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    });
    if (!socket) {
      if (errno != EAGAIN) {
        accept_again_ = now_ + accept_pause;  // out of descriptors: they do not come back by asking
      }
      return;
    }
    if (is_same_user(socket.get())) {
      try {
        auto client = std::make_unique<HubClient>(std::move(socket), now_);
        poller_.add(client->stream().fd(), client.get());
        clients_.push_back(std::move(client));
      } catch (const std::system_error&) {
        accept_again_ = now_ + accept_pause;  // the same; the client asks again
      }
    }
  }
}

void Hub::read(HubClient& client) {
  Stream& stream = client.stream();
  for (int i = 0; i < reads_per_round && stream.open(); ++i) {
    const Stream::Read read = stream.read();
    if (read == Stream::Read::nothing) {
      return;
    }
    if (read == Stream::Read::end) {
      cut(client);
      return;
    }
    Record record{};
    Split split = Split::incomplete;
    while (stream.open() && (split = stream.take(record)) == Split::record) {
      handle(client, record);
    }
    if (split == Split::malformed) {
      cut(client);
    }
    if (!stream.filled()) {
      return;
    }
  }
}

void Hub::handle(HubClient& client, const Record& record) {
  if (client.greeted() == (record.type == RecordType::hello)) {
    cut(client);
    return;
  }
  switch (record.type) {
    case RecordType::hello:
      greet(client, record.as<Hello>());
      break;
    case RecordType::frame:
      take_frame(client, record.as<OfferedFrame>());
      break;
    case RecordType::go_on:
      break;  // it has woken this thread
    default:
      cut(client);
      break;
  }
}

void Hub::greet(HubClient& client, const Hello& hello) {
  const bool is_alive = hello.client != 0 && is_present(seat_.lock_fd(), hello.client);
  if (hello.magic != magic || (hello.version == protocol_version && !is_alive)) {
    cut(client);
  } else if (const auto why = objection_to(hello)) {
    refuse(client, *why);
  } else if (hello.host == Hello::wants_the_seat) {
    // Its seat from now on. This hub goes, and that client finds it free.
    memory_->header.host.store(hello.client, std::memory_order_seq_cst);
    is_over_ = true;
  } else if (const bool fresh = !roster_.slot_of(hello.client);
             const auto slot = give_slot(hello.client)) {
    if (hello.host == Hello::has_the_seat && !roster_.has_host_but(hello.client)) {
      memory_->header.host.store(hello.client, std::memory_order_seq_cst);
    }
    let_in(client, hello.client, *slot, fresh);
  } else {
    refuse(client, Errc::bus_full);
  }
}

std::optional<Errc> Hub::objection_to(const Hello& hello) const {
  if (hello.version != protocol_version) {
    return Errc::version_mismatch;
  }
  if (hello.bitrate_bps != 0 && hello.bitrate_bps != medium_->bitrate_bps().value_or(0)) {
    return Errc::bitrate_mismatch;
  }
  if (hello.host == Hello::wants_the_seat && roster_.has_host_but(hello.client)) {
    return Errc::carried_already;
  }
  return std::nullopt;
}

void Hub::refuse(HubClient& client, Errc why) {
  client.refuse({static_cast<std::uint32_t>(why), medium_->bitrate_bps().value_or(0)});
}

void Hub::let_in(HubClient& client, std::uint64_t number, std::size_t slot, bool fresh) {
  medium_->drop_station_of(number);
  auto station = std::make_shared<Station>(number, slot);
  const Welcome welcome{memory_->header.identity.load(std::memory_order_relaxed),
                        static_cast<std::uint32_t>(slot), medium_->bitrate_bps().value_or(0),
                        window(), fresh ? 1U : 0U};
  if (!client.welcome(station, slot, welcome)) {
    cut(client);
    return;
  }
  medium_->attach(std::move(station));
  readers_.set_wake(slot, &client.wake());
  readers_.wake(slot);  // the last hub may have died before it did
}

/// The one that it has, or a free one; none: there is none.
std::optional<std::size_t> Hub::give_slot(std::uint64_t client) {
  if (const auto slot = roster_.slot_of(client)) {
    // It knows before this hub does that its last connection is over.
    for (const auto& other : clients_) {
      if (other->greeted() && other->slot() == *slot) {
        cut(*other);
        let_go(*other);
      }
    }
    return slot;
  }
  if (!roster_.slot_of(0)) {
    free_slots_of_the_dead();
  }
  return roster_.take_free(client);
}

void Hub::free_slots_of_the_dead() {
  Roster::Connected connected{};
  for (const auto& client : clients_) {
    if (client->greeted() && client->stream().open()) {
      connected.at(client->slot()) = true;
    }
  }
  roster_.free_dead(connected);
}

void Hub::take_frame(HubClient& client, const OfferedFrame& offered) {
  const std::optional<Frame> frame = from_wire(offered.frame);
  // A client of ours stays within its window; what does not is no client of ours.
  if (!frame || offered.lane >= lane_count || client.station()->waiting(offered.lane) > window()) {
    cut(client);
    return;
  }
  const Slot& slot = memory_->slots.at(client.slot());
  if (offered.sequence > slot.done.at(offered.lane).load(std::memory_order_relaxed)) {
    client.station()->add(offered.lane, {*frame, offered.sequence});
  }
  medium_->offered(now_);
}

void Hub::transmit() {
  if (!medium_->contended() && !medium_->next_end()) {
    return;
  }
  holding_ = !medium_->bitrate_bps() && readers_.hold_bus(now_);
  const std::size_t listeners = readers_.listeners();
  std::size_t carried = 0;
  while (!holding_ && carried < frames_per_round) {
    const auto transmission = medium_->next(now_);
    if (!transmission) {
      break;
    }
    carry(*transmission, listeners);
    ++carried;
  }
  if (carried > 0) {
    readers_.wake_for_news();
    for (const std::size_t slot : done_) {
      readers_.wake_for_done(slot);
    }
    done_.clear();
  }
}

void Hub::carry(const Medium::Transmission& transmission, std::size_t listeners) {
  const auto& [from, offer, lane, end] = transmission;
  Slot& slot = memory_->slots.at(from->slot());
  const bool is_there = slot.client.load(std::memory_order_relaxed) == from->sender();
  if (is_there && offer.sequence <= slot.done.at(lane).load(std::memory_order_relaxed)) {
    return;  // a client that has come back had offered it twice
  }
  std::atomic<std::uint64_t>& head = memory_->header.head;
  const std::uint64_t number = head.load(std::memory_order_relaxed) + 1;
  if (number > log_size) {
    readers_.take_away(number - log_size);
  }
  const std::int64_t time_ns =
      std::chrono::nanoseconds(end.time_since_epoch()).count() + wall_offset_ns_;
  store(entry_of(*memory_, number),
        {from->sender(), offer.sequence, lane, time_ns, to_wire(offer.frame)});
  head.store(number, std::memory_order_seq_cst);
  if (!is_there) {
    return;  // its client has gone
  }
  // Before it is done: who then looks knows.
  if (listeners == (Readers::listens(slot) ? 1 : 0)) {
    slot.unheard.fetch_add(1, std::memory_order_relaxed);
  }
  slot.done.at(lane).store(offer.sequence, std::memory_order_seq_cst);
  if (done_.empty() || done_.back() != from->slot()) {
    done_.push_back(from->slot());
  }
}

// Once; the slot may have another connection by the time the client itself is dropped.
void Hub::let_go(HubClient& client) {
  if (const auto station = client.end()) {
    readers_.set_wake(client.slot(), nullptr);
    medium_->detach(station);
  }
}

void Hub::drop_closed_clients() {
  const auto closed = [this](const std::unique_ptr<HubClient>& client) {
    if (client->stream().open()) {
      return false;
    }
    let_go(*client);
    return true;
  };
  if (std::erase_if(clients_, closed) > 0) {
    free_slots_of_the_dead();
  }
}

// All that has been carried is in the memory, for whoever is still to read it. The seat is free
// before anybody sees that this hub has gone.
void Hub::leave() noexcept {
  seat_.leave(!roster_.has_anybody());
  for (const auto& client : clients_) {
    cut(*client);
  }
  clients_.clear();
}

}  // namespace roio::local
