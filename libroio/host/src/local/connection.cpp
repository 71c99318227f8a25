#include "local/connection.hpp"

#include <poll.h>

#include <array>
#include <chrono>
#include <random>
#include <roio/error.hpp>
#include <utility>

namespace roio::local {
namespace {

using std::chrono::milliseconds;

// A hub answers in microseconds. One that does not may be about to leave: then ask again.
constexpr milliseconds greeting_time{500};
constexpr milliseconds first_pause{1};
constexpr milliseconds longest_pause{20};

std::uint64_t random_client() {
  std::random_device device;
  return (std::uint64_t{device()} << 32) | device();
}

/// @return false: the time is up, or stop is set.
bool wait_readable(int fd, milliseconds timeout, const EventFlag& stop) {
  std::array<pollfd, 2> entries{{{fd, POLLIN, 0}, {stop.fd(), POLLIN, 0}}};
  return ::poll(entries.data(), entries.size(), static_cast<int>(timeout.count())) > 0 &&
         entries[1].revents == 0;
}

milliseconds at_most(milliseconds limit, const Deadline& deadline) {
  return std::min(limit, std::chrono::ceil<milliseconds>(deadline.remaining()));
}

}  // namespace

Connector::Connector(const std::string& bus_name, std::optional<std::uint32_t> bitrate_bps,
                     bool may_be_hub)
    : bus_name_(bus_name),
      bitrate_bps_(bitrate_bps),
      may_be_hub_(may_be_hub),
      client_(random_client()),
      place_(bus_name) {}

std::optional<Connection> Connector::connect(const Deadline& deadline, const EventFlag& stop) {
  for (milliseconds pause = first_pause; !stop.is_set();
       pause = std::min(pause * 2, longest_pause)) {
    if (UniqueFd socket = place_.connect()) {
      if (auto connection = greet(std::move(socket), deadline, stop)) {
        return connection;
      }
    } else if (auto seat = may_be_hub_ ? place_.claim() : std::nullopt) {
      hub_ = std::make_unique<Hub>(std::move(*seat), bitrate_bps_);
      continue;
    }
    if (deadline.passed()) {
      break;
    }
    static_cast<void>(wait_readable(-1, at_most(pause, deadline), stop));
  }
  return std::nullopt;
}

std::optional<Connection> Connector::greet(UniqueFd socket, const Deadline& deadline,
                                           const EventFlag& stop) {
  static_assert(sizeof(Welcome) == sizeof(Refused), "read before it is known which one comes");
  Stream stream(std::move(socket));
  append_record(stream.out(),
                Hello{magic, protocol_version, was_connected_ ? std::uint16_t{1} : std::uint16_t{0},
                      client_, bitrate_bps_.value_or(0), 0});
  if (!stream.flush() || !stream.flushed() ||
      !wait_readable(stream.fd(), at_most(greeting_time, deadline), stop)) {
    return std::nullopt;
  }
  std::array<std::uint8_t, sizeof(RecordHead) + sizeof(Welcome)> answer{};
  UniqueFd page;
  const std::size_t size = receive_with_fd(stream.fd(), answer, page);
  std::span<const std::uint8_t> bytes = std::span(answer).first(size);
  Record record{};
  if (take_record(bytes, record) != Split::record) {
    return std::nullopt;
  }
  if (record.type == RecordType::refused) {
    throw_refused(record.as<Refused>());
  }
  if (record.type != RecordType::welcome || !page) {
    throw std::system_error(Errc::version_mismatch, "local:" + bus_name_);
  }
  const auto welcome = record.as<Welcome>();
  if (welcome.bitrate_bps != 0) {
    bitrate_bps_ = welcome.bitrate_bps;  // a hub that we may have to start goes on at the same rate
  }
  was_connected_ = true;
  return Connection{std::move(stream), CounterPage(std::move(page)), welcome};
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
