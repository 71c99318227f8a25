#ifndef ROIO_LOCAL_MEDIUM_HPP
#define ROIO_LOCAL_MEDIUM_HPP

#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "local/protocol.hpp"

namespace roio::local {

/// One client's frames that wait for the bus: what a controller's transmit buffers are on a real
/// one.
class Station {
 public:
  /// @param slot of its client in the bus's memory.
  Station(std::uint64_t sender, std::size_t slot) : sender_(sender), slot_(slot) {}

  struct Offer {
    Frame frame;
    std::uint64_t sequence;
  };

  void add(std::size_t lane, const Offer& offer) { lanes_.at(lane).push_back(offer); }
  /// Its client offers all of them anew.
  void clear();
  [[nodiscard]] std::uint64_t sender() const { return sender_; }
  [[nodiscard]] std::size_t slot() const { return slot_; }
  [[nodiscard]] bool empty() const {
    return waiting(urgent_lane) == 0 && waiting(normal_lane) == 0;
  }
  [[nodiscard]] std::size_t waiting(std::size_t lane) const { return lanes_.at(lane).size(); }

  /// The lane that this station contends with: urgent frames pass normal ones. None when empty.
  [[nodiscard]] std::optional<std::size_t> lane() const;
  /// The first frame of that lane. Not when empty.
  [[nodiscard]] const Offer& front() const { return lanes_.at(*lane()).front(); }
  Offer take();

 private:
  std::uint64_t sender_;
  std::size_t slot_;
  std::array<std::deque<Offer>, lane_count> lanes_;
};

/// The wire between the stations: lowest arbitration key first and, when it has a bit rate, one
/// frame at a time for as long as its bits take. Without one, frames pass in no time. Time is the
/// caller's.
class Medium {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  struct Transmission {
    std::shared_ptr<Station> from;
    Station::Offer offer;
    std::size_t lane;
    TimePoint end;  ///< When the frame's last bit has passed.
  };

  explicit Medium(std::optional<std::uint32_t> bitrate_bps) : bitrate_bps_(bitrate_bps) {}

  [[nodiscard]] std::optional<std::uint32_t> bitrate_bps() const { return bitrate_bps_; }

  void attach(std::shared_ptr<Station> station) { stations_.push_back(std::move(station)); }
  /// The station stays until its frames have been sent, as a controller's would.
  void detach(const std::shared_ptr<Station>& station);
  /// A client has come back, and offers anew what its station still had.
  void drop_station_of(std::uint64_t sender);

  /// Tells that stations may have been given frames, by `now`.
  void offered(TimePoint now);

  /// The next frame that has passed by `now`, if there is one. Call until there is none.
  std::optional<Transmission> next(TimePoint now);

  /// Whether frames wait for the wire: next() has not found since offered() that there are none.
  [[nodiscard]] bool contended() const { return contended_; }

  /// When next() will have something by itself; none: not before offered().
  [[nodiscard]] std::optional<TimePoint> next_end() const;

 private:
  std::optional<Transmission> arbitrate(TimePoint now);
  [[nodiscard]] bool all_empty() const;
  void drop_detached();

  std::optional<std::uint32_t> bitrate_bps_;
  std::vector<std::shared_ptr<Station>> stations_;
  std::vector<std::shared_ptr<Station>> detached_;
  std::optional<Transmission> on_wire_;
  std::size_t first_ = 0;  // the station asked first when several have the same key
  TimePoint idle_since_{};
  bool contended_ = false;
};

}  // namespace roio::local

#endif
