#ifndef ROIO_SIM_NETWORK_STATION_HPP
#define ROIO_SIM_NETWORK_STATION_HPP

#include <cstdint>
#include <memory>
#include <roio/bus.hpp>
#include <roio/mcp2515.hpp>
#include <roio/parts/controller_report.hpp>
#include <roio/sim/mcp2515_chip.hpp>
#include <roio/sim/network.hpp>
#include <roio/sim/spi_wire.hpp>

#include "network/exchange.hpp"

namespace roio::sim {

/// How often a participant's processor calls its driver. Two of the shortest frames at 1 Mbit/s
/// take 94 us.
constexpr SimTime poll_interval = std::chrono::microseconds(25);

/// A participant on the wire: a chip, the driver on it, and what its processor does. For the
/// simulation's thread alone.
class Station {
 public:
  /// @param timing for the options' rate and oscillator.
  /// @param epoch what the clock of the wall says when simulated time is 0.
  Station(CanBus& bus, const NetworkOptions& options, const BitTiming& timing, Timestamp epoch,
          std::shared_ptr<Exchange> exchange);
  Station(const Station&) = delete;
  Station& operator=(const Station&) = delete;
  ~Station() = default;

  /// Simulated time goes on meanwhile, by milliseconds. @return as the driver's begin().
  Status begin();

  /// One round of the processor's loop.
  void poll();

  [[nodiscard]] bool wants_to_leave() const { return exchange_->wants_to_leave(); }
  /// Takes back what is not yet on the wire; simulated time goes on until that has come to its end.
  /// @return who is to be told when the station is gone.
  std::shared_ptr<Exchange> leave();
  [[nodiscard]] bool has_left() const { return left_; }

  /// Tells the program that the simulation ends.
  void end() { exchange_->end(); }

  [[nodiscard]] const Exchange& exchange() const { return *exchange_; }

 private:
  struct Traits : Mcp2515Traits {
    using Count = std::uint64_t;
    static constexpr bool all_kinds = true;
    static constexpr bool reports_outcomes = true;
    void on_outcome(std::uint8_t /*token*/, TxOutcome outcome) const {
      exchange->settled(outcome == TxOutcome::sent);
    }
    Exchange* exchange = nullptr;
  };
  // No queue of the driver's for sending: the exchange has two, so that urgent frames find room
  // where normal ones do not.
  using Driver = Mcp2515<ChipPort<true>, 2, 0, Traits>;

  void receive();
  void send();
  void look_for_news();
  [[nodiscard]] ControllerView view();
  [[nodiscard]] Timestamp now() const;

  CanBus& bus_;
  Mcp2515Config config_;
  SimTime longest_frame_;
  Timestamp epoch_;
  std::shared_ptr<Exchange> exchange_;
  Mcp2515Chip chip_;
  SpiWire wire_;
  Driver can_;
  ControllerView told_;
  bool beginning_ = false;
  bool left_ = false;
};

}  // namespace roio::sim

#endif
