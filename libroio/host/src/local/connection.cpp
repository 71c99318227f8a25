#include "local/connection.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <roio/error.hpp>
#include <utility>

namespace roio::local {
namespace {

using std::chrono::milliseconds;

// A hub answers in microseconds. One that does not may be about to leave: then ask again.
constexpr milliseconds greeting_time{500};
// In which a bus whose hub has gone has another, or is left to one who is there for that.
constexpr milliseconds takeover_time{200};
// A host that could not carry the bus leaves it to others for so long: to ask for it all the time
// would take it from them as often.
constexpr std::chrono::seconds rest_time{10};
constexpr milliseconds first_pause{1};
constexpr milliseconds longest_pause{20};

/// @return false: the time is up, or stop is set.
bool wait_readable(int fd, milliseconds timeout, const EventFlag& stop) {
  std::array<pollfd, 2> entries{{{fd, POLLIN, 0}, {stop.fd(), POLLIN, 0}}};
  return ::poll(entries.data(), entries.size(), static_cast<int>(timeout.count())) > 0 &&
         entries[1].revents == 0;
}

bool is_memory_of(int lock_fd, std::uint64_t identity) {
  const MemoryView memory(lock_fd);
  return memory && memory->header.identity.load(std::memory_order_relaxed) == identity;
}

}  // namespace

Connector::Connector(const std::string& bus_name, std::optional<std::uint32_t> bitrate_bps,
                     Carry carry)
    : bus_name_(bus_name),
      bitrate_bps_(bitrate_bps),
      carry_(carry),
      client_(random_number()),
      place_(bus_name) {}

std::optional<Connection> Connector::connect(const Deadline& deadline, const EventFlag& stop) {
  silent_hub_.reset();
  if (hub_ && hub_->has_failed()) {
    rests_.emplace(rest_time);
    hub_.reset();
  }
  const Deadline taken_over(takeover_time);
  for (milliseconds pause = first_pause; !stop.is_set();
       pause = std::min(pause * 2, longest_pause)) {
    if (auto hub = place_.find()) {
      if (auto connection = greet(std::move(*hub), stop)) {
        return connection;
      }
    } else if (auto seat = may_claim(taken_over) ? place_.claim() : std::nullopt) {
      carry(std::move(*seat));
      continue;
    }
    if (deadline.passed() && (taken_over.passed() || !is_between_hubs())) {
      break;
    }
    static_cast<void>(wait_readable(-1, pause, stop));
  }
  return std::nullopt;
}

/// @throws std::system_error: it cannot, for want of descriptors or threads. std::bad_alloc.
void Connector::carry(HubSeat seat) {
  try {
    hub_ =
        std::make_unique<Hub>(std::move(seat), bitrate_bps_, carry_ == Carry::always ? client_ : 0);
    rests_.reset();
  } catch (...) {
    rests_.emplace(rest_time);
    throw;
  }
}

/// Whether this client may be the hub now. @param others_first how long it is left to another that
/// is there for it, and has not come yet.
bool Connector::may_claim(const Deadline& others_first) const {
  if (carry_ == Carry::never) {
    return false;
  }
  if (others_first.passed()) {
    return true;
  }
  const std::vector<std::string> paths = place_.lock_paths();
  return std::none_of(paths.begin(), paths.end(), [this](const std::string& path) {
    const std::uint64_t host = MemoryView(path).host();
    return host != 0 && host != client_;
  });
}

/// Whether a bus is there, and one of its clients about to carry it.
bool Connector::is_between_hubs() const {
  const std::vector<std::string> paths = place_.lock_paths();
  return std::any_of(paths.begin(), paths.end(),
                     [](const std::string& path) { return MemoryView(path).has_clients(); });
}

/// @return Hello::host. @throws Errc::carried_already: another is there, and has been since open().
std::uint16_t Connector::wish_for_the_seat(const Place::Hub& hub) const {
  if (carry_ != Carry::always) {
    return 0;
  }
  const std::uint64_t host = MemoryView(hub.lock_path).host();
  if (host != 0 && host != client_) {
    if (!was_connected_) {
      throw std::system_error(Errc::carried_already,
                              "local:" + bus_name_ + ": " + describe_process(hub.process));
    }
    return 0;
  }
  if (rests_ && !rests_->passed()) {
    return 0;
  }
  return hub.process == ::getpid() ? Hello::has_the_seat : Hello::wants_the_seat;
}

std::system_error Connector::why_not() const {
  const std::string name = "local:" + bus_name_;
  std::optional<pid_t> carrier = silent_hub_;
  if (!carrier) {  // it may be so silent that it does not even take connections
    for (const std::string& path : place_.lock_paths()) {
      const MemoryView memory(path);
      carrier = memory.has_clients() ? std::optional(memory->header.process.load()) : carrier;
    }
  }
  return carrier && is_stopped(*carrier)
             ? std::system_error(Errc::carrier_stopped, name + ": " + describe_process(*carrier))
             : std::system_error(Errc::not_connected, name);
}

std::optional<Connection> Connector::greet(Place::Hub hub, const EventFlag& stop) {
  static_assert(sizeof(Welcome) >= sizeof(Refused), "read before it is known which one comes");
  const std::uint16_t wish = wish_for_the_seat(hub);
  if (!presence_.is_at(hub.lock_path)) {
    presence_ = Presence(hub.lock_path, client_);
  }
  Stream stream(std::move(hub.socket));
  append_record(stream.out(),
                Hello{magic, protocol_version, wish, client_, bitrate_bps_.value_or(0), 0});
  if (!presence_.shown() || !stream.flush() || !stream.flushed()) {
    return std::nullopt;  // that hub is leaving
  }
  // Whatever the deadline: who asks without waiting is told of a bus that is there.
  if (!wait_readable(stream.fd(), greeting_time, stop)) {
    silent_hub_ = hub.process;
    return std::nullopt;
  }
  std::array<std::uint8_t, sizeof(RecordHead) + sizeof(Welcome)> answer{};
  UniqueFd wake;
  const std::size_t size = receive_with_fd(stream.fd(), answer, wake);
  std::span<const std::uint8_t> bytes = std::span(answer).first(size);
  Record record{};
  switch (take_record(bytes, record)) {
    case Split::incomplete:
      return std::nullopt;
    case Split::malformed:
      throw std::system_error(Errc::version_mismatch, "local:" + bus_name_);
    case Split::record:
      break;
  }
  if (record.type == RecordType::refused) {
    throw_refused(record.as<Refused>());
  }
  if (record.type == RecordType::welcome && !wake) {
    throw std::system_error(EMFILE, std::generic_category(), "local:" + bus_name_);
  }
  if (record.type != RecordType::welcome) {
    throw std::system_error(Errc::version_mismatch, "local:" + bus_name_);
  }
  const auto welcome = record.as<Welcome>();
  if (welcome.slot >= max_clients || !is_memory_of(presence_.fd(), welcome.identity)) {
    return std::nullopt;  // its files have been replaced under it; it is about to notice
  }
  if (welcome.bitrate_bps != 0) {
    bitrate_bps_ = welcome.bitrate_bps;  // a hub that we may have to start goes on at the same rate
  }
  was_connected_ = true;
  ClientMemory memory(presence_.fd(), welcome.slot);
  return Connection{std::move(stream), std::move(memory), std::move(wake), welcome, hub.process};
}

void Connector::throw_refused(const Refused& refused) const {
  std::string what = "local:" + bus_name_;
  const auto errc = static_cast<Errc>(refused.errc);
  if (errc == Errc::bitrate_mismatch) {
    what += "?bitrate=" + std::to_string(bitrate_bps_.value_or(0)) + " (it runs " +
            (refused.bitrate_bps == 0 ? "without a bit rate"
                                      : "at " + std::to_string(refused.bitrate_bps) + " bit/s") +
            ")";
  }
  throw std::system_error(errc, what);
}

}  // namespace roio::local
