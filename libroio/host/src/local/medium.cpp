#include "local/medium.hpp"

#include <algorithm>
#include <roio/frame_length.hpp>
#include <utility>

namespace roio::local {
namespace {

// A process that was stopped for longer goes on from now: no real bus brings at once what it did
// not carry meanwhile.
constexpr std::chrono::milliseconds longest_catch_up{100};

}  // namespace

void Station::clear() {
  for (auto& lane : lanes_) {
    lane.clear();
  }
}

std::optional<std::size_t> Station::lane() const {
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    if (waiting(lane) > 0) {
      return lane;
    }
  }
  return std::nullopt;
}

Station::Offer Station::take() {
  auto& lane = lanes_.at(*this->lane());
  const Offer offer = lane.front();
  lane.pop_front();
  return offer;
}

void Medium::detach(const std::shared_ptr<Station>& station) {
  detached_.push_back(station);
  drop_detached();
}

void Medium::drop_detached() {
  std::erase_if(detached_, [this](const std::shared_ptr<Station>& station) {
    return station->empty() && std::erase(stations_, station) > 0;
  });
}

void Medium::drop_station_of(std::uint64_t sender) {
  for (const auto& station : detached_) {
    if (station->sender() == sender) {
      station->clear();
    }
  }
  drop_detached();
}

void Medium::offered(TimePoint now) {
  if (!contended_) {
    idle_since_ = std::max(idle_since_, now);
    contended_ = true;
  }
}

std::optional<Medium::Transmission> Medium::next(TimePoint now) {
  if (!on_wire_) {
    on_wire_ = arbitrate(now);
    if (!on_wire_) {
      contended_ = !all_empty();
      return std::nullopt;
    }
  }
  if (!bitrate_bps_) {
    on_wire_->end = now;
  } else if (on_wire_->end > now) {
    return std::nullopt;
  }
  idle_since_ = on_wire_->end;
  return std::exchange(on_wire_, std::nullopt);
}

bool Medium::all_empty() const {
  return std::all_of(stations_.begin(), stations_.end(),
                     [](const auto& station) { return station->empty(); });
}

std::optional<Medium::TimePoint> Medium::next_end() const {
  return on_wire_ ? std::optional(on_wire_->end) : std::nullopt;
}

// The wire is taken from the moment it was idle and somebody had a frame, not from when this
// process got round to it: so a late wake-up does not make the bus slower than its bit rate.
std::optional<Medium::Transmission> Medium::arbitrate(TimePoint now) {
  std::optional<std::size_t> winner;
  std::uint32_t lowest = 0;
  for (std::size_t i = 0; i < stations_.size(); ++i) {
    const std::size_t index = (first_ + i) % stations_.size();
    if (stations_[index]->empty()) {
      continue;
    }
    const std::uint32_t key = arbitration_key(stations_[index]->front().frame);
    if (!winner || key < lowest) {
      winner = index;
      lowest = key;
    }
  }
  if (!winner) {
    return std::nullopt;
  }
  first_ = *winner + 1;  // so that two stations with one identifier take turns
  const std::shared_ptr<Station> from = stations_[*winner];
  const std::size_t lane = *from->lane();
  const Station::Offer offer = from->take();
  if (!detached_.empty()) {
    drop_detached();
  }
  idle_since_ = std::max(idle_since_, now - longest_catch_up);
  std::chrono::nanoseconds duration{0};
  if (bitrate_bps_) {
    duration = std::chrono::nanoseconds(std::uint64_t{wire_bits(offer.frame)} * 1'000'000'000 /
                                        *bitrate_bps_);
  }
  return Transmission{from, offer, lane, idle_since_ + duration};
}

}  // namespace roio::local
