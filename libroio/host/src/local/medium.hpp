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
/// one. A frame is given first, and may be taken once asked_again() has been called twice.
class Station {
 public:
  explicit Station(std::uint64_t sender) : sender_(sender) {}

  struct Offer {
    Frame frame;
    std::uint64_t sequence;
  };

  void add(std::size_t lane, const Offer& offer) { lanes_.at(lane).waiting.push_back(offer); }
  /// Every client has been asked once more: what had been added when this was last called, may be
  /// taken from now on.
  void asked_again();
  [[nodiscard]] std::uint64_t sender() const { return sender_; }
  [[nodiscard]] bool empty() const {
    return waiting(urgent_lane) == 0 && waiting(normal_lane) == 0;
  }
  [[nodiscard]] std::size_t waiting(std::size_t lane) const {
    return lanes_.at(lane).waiting.size();
  }

  /// The lane that this station contends with: urgent frames pass normal ones. None when empty.
  [[nodiscard]] std::optional<std::size_t> lane() const;
  /// The first frame of that lane. Not when empty.
  [[nodiscard]] const Offer& front() const { return lanes_.at(*lane()).waiting.front(); }
  /// Whether it may be taken yet.
  [[nodiscard]] bool may_take() const { return lanes_.at(*lane()).ready > 0; }
  Offer take();

 private:
  struct Lane {
    std::deque<Offer> waiting;
    std::size_t ready = 0;       // of waiting, from the front: may be taken
    std::size_t next_ready = 0;  // ready, once asked_again() has been called
  };

  std::uint64_t sender_;
  std::array<Lane, lane_count> lanes_;
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

  /// Tells that every client has been asked once more, at `now`, for what it has sent.
  ///
  /// Frames that stations had been given before that round may pass from now on; those of the round
  /// itself not yet. For clients are asked one after the other: what the first sent before the last
  /// did (its filters: it means to hear the last one's frame) may have come just after it was
  /// asked, and is known a round later. A frame that would win is waited for.
  void asked_all(TimePoint now);

  /// The next frame that has passed by `now`, if there is one. Call until there is none.
  std::optional<Transmission> next(TimePoint now);

  /// Whether frames may wait: asked_all(), and next() has not found since that there are none.
  [[nodiscard]] bool contended() const { return contended_; }

  /// When next() will have something by itself; none: not before asked_all().
  [[nodiscard]] std::optional<TimePoint> next_end() const;

 private:
  std::optional<Transmission> arbitrate();
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
