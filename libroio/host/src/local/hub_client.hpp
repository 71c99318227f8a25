#ifndef ROIO_LOCAL_HUB_CLIENT_HPP
#define ROIO_LOCAL_HUB_CLIENT_HPP

#include <chrono>
#include <cstddef>
#include <memory>
#include <roio/parts/fd.hpp>
#include <utility>

#include "local/medium.hpp"
#include "local/protocol.hpp"
#include "local/stream.hpp"

namespace roio::local {

/// The hub's side of one client's connection.
class HubClient {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  HubClient(ParentsFd socket, TimePoint now) : stream_(std::move(socket)), since_(now) {}

  [[nodiscard]] Stream& stream() { return stream_; }
  [[nodiscard]] bool greeted() const { return station_ != nullptr; }
  /// It has been connected for a while, and has not said who it is.
  [[nodiscard]] bool greeting_overdue(TimePoint now) const;

  /// Lets the client in. @return false: the connection is gone.
  bool welcome(std::shared_ptr<Station> station, std::size_t slot, const Welcome& welcome);
  void refuse(const Refused& refused);

  /// It is let go. @return its station; null when it has been already, or never greeted.
  std::shared_ptr<Station> end() { return std::exchange(station_, nullptr); }

  // Once greeted.
  [[nodiscard]] const std::shared_ptr<Station>& station() const { return station_; }
  [[nodiscard]] std::size_t slot() const { return slot_; }
  [[nodiscard]] EventFlag& wake() { return wake_; }

 private:
  Stream stream_;
  TimePoint since_;  // of the connection
  EventFlag wake_;   // passed to the client
  std::shared_ptr<Station> station_;
  std::size_t slot_ = 0;
};

}  // namespace roio::local

#endif
