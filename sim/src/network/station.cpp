#include "network/station.hpp"

#include <optional>
#include <utility>

namespace roio::sim {
namespace {

// Its processor and its SPI take no simulated time (network.hpp).
constexpr SpiWire::Timing no_time{SimTime(0), SimTime(0)};

// More bits than the longest frame has, with an error frame and the pause after both.
constexpr int bits_of_any_frame = 200;

BusState to_bus_state(Mcp2515State state) {
  switch (state) {
    case Mcp2515State::active:
      return BusState::active;
    case Mcp2515State::warning:
      return BusState::warning;
    case Mcp2515State::passive:
      return BusState::passive;
    case Mcp2515State::bus_off:
      return BusState::bus_off;
  }
  return BusState::active;
}

}  // namespace

Station::Station(CanBus& bus, const NetworkOptions& options, const BitTiming& timing,
                 Timestamp epoch, std::shared_ptr<Exchange> exchange)
    : bus_(bus),
      config_(timing, mcp2515_filters_of_everything()),
      longest_frame_(cycles(bits_of_any_frame, options.bitrate_bps)),
      epoch_(epoch),
      exchange_(std::move(exchange)),
      chip_(bus, {.osc_hz = options.osc_hz}),
      wire_(bus, chip_, no_time),
      can_(wire_) {
  can_.traits().exchange = exchange_.get();
}

Status Station::begin() {
  beginning_ = true;
  const Status status = can_.begin(config_);
  beginning_ = false;
  return status;
}

void Station::poll() {
  if (beginning_) {
    return;
  }
  if (!can_.running()) {
    // The driver has found its chip reset or not there.
    if (begin() != Status::ok) {
      return;
    }
    exchange_->count_outage();
  }
  receive();
  send();
  look_for_news();
}

void Station::receive() {
  Frame frame{};
  while (can_.receive(frame) == Status::ok) {
    exchange_->deliver(frame, now());
  }
}

void Station::send() {
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    std::optional<Frame> frame;
    while ((frame = exchange_->next(lane, bus_.now())) && can_.send(*frame) == Status::ok) {
      exchange_->handed_over(lane);
    }
  }
}

ControllerView Station::view() {
  const Driver::Counters& counters = can_.counters();
  ControllerView view;
  view.state = to_bus_state(can_.state());
  view.overruns = counters.overflows;
  view.bus_offs = counters.bus_offs;
  view.message_errors = counters.message_errors;
  return view;
}

void Station::look_for_news() {
  ControllerView view = this->view();
  if (!is_news(told_, view)) {
    return;
  }
  can_.read_error_counters(view.transmit_errors, view.receive_errors);
  exchange_->tell({view.state, error_report(told_, view), view.overruns - told_.overruns,
                   view.bus_offs - told_.bus_offs},
                  now());
  told_ = view;
}

Timestamp Station::now() const {
  return epoch_ + std::chrono::duration_cast<std::chrono::nanoseconds>(bus_.now());
}

std::shared_ptr<Exchange> Station::leave() {
  exchange_->abandon();
  can_.abort();
  for (const SimTime end = bus_.now() + longest_frame_; can_.in_flight() > 0 && bus_.now() < end;) {
    bus_.run_for(poll_interval);
  }
  for (auto left = can_.in_flight(); left > 0; --left) {
    exchange_->settled(false);
  }
  left_ = true;
  return exchange_;
}

}  // namespace roio::sim
