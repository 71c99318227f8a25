/// SpiWire: what lies between a microcontroller and the simulated chip: an SPI that takes its time,
/// and that can fail.
#ifndef ROIO_SIM_SPI_WIRE_HPP
#define ROIO_SIM_SPI_WIRE_HPP

#include <cstdint>
#include <functional>
#include <random>
#include <roio/sim/can_bus.hpp>
#include <roio/sim/mcp2515_chip.hpp>

namespace roio::sim {

class SpiWire {
 public:
  struct Timing {
    SimTime byte = cycles(8, 8'000'000);  ///< What one byte takes.
    SimTime select{0};                    ///< What raising or lowering chip select takes.
  };
  enum class Fault : std::uint8_t {
    none,
    stuck_low,   ///< The chip is not reached, and the microcontroller reads 0x00.
    stuck_high,  ///< The chip is not reached, and the microcontroller reads 0xFF.
  };

  SpiWire(CanBus& bus, Mcp2515Chip& chip) : SpiWire(bus, chip, Timing()) {}
  SpiWire(CanBus& bus, Mcp2515Chip& chip, const Timing& timing)
      : bus_(bus), chip_(chip), timing_(timing) {}

  // --- the microcontroller's side: the bus runs while a byte is under way ------------------------

  void select();
  std::uint8_t exchange(std::uint8_t out);
  void deselect();
  [[nodiscard]] bool interrupt_line_is_low();
  /// The microcontroller does something else for a while.
  void pass(SimTime span) { bus_.run_for(span); }
  [[nodiscard]] SimTime now() const { return bus_.now(); }

  // --- faults ------------------------------------------------------------------------------------

  /// From the next byte on; in the middle of a transaction the chip sees its select line go high.
  void set_fault(Fault fault);
  /// Each bit of each byte, both ways, is flipped with this probability.
  void set_bit_flips(double probability, std::uint32_t seed);
  /// Once, before the byte that comes after `bytes` more, chip select goes high and low again.
  void lose_select_after(std::uint32_t bytes) { lose_select_in_ = bytes + 1; }

  /// The next look at the interrupt line finds it low.
  void spike_on_interrupt_line() { spike_ = true; }
  /// The interrupt line is at ground, whatever the chip says.
  void hold_interrupt_line_low(bool hold) { line_held_low_ = hold; }
  /// The interrupt line is not connected, or is again: the microcontroller's pull-up makes it high.
  void cut_interrupt_line(bool cut) { line_cut_ = cut; }
  /// No fault any more, nor one to come.
  void clear_faults();

  // --- for tests ---------------------------------------------------------------------------------

  /// Called before each byte and before each edge of chip select.
  void on_step(std::function<void()> listener) { step_ = std::move(listener); }
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
  /// Those with at least one byte.
  [[nodiscard]] std::uint64_t transactions() const { return transactions_; }
  [[nodiscard]] bool selected() const { return selected_; }

 private:
  std::uint8_t with_flips(std::uint8_t byte);
  void step() const {
    if (step_) {
      step_();
    }
  }

  CanBus& bus_;
  Mcp2515Chip& chip_;
  Timing timing_;
  Fault fault_ = Fault::none;
  std::function<void()> step_;
  std::bernoulli_distribution flip_{0};
  std::mt19937 generator_;
  std::uint32_t lose_select_in_ = 0;  // 0: not at all
  bool spike_ = false;
  bool line_held_low_ = false;
  bool line_cut_ = false;
  bool selected_ = false;
  bool first_byte_ = false;
  std::uint64_t bytes_ = 0;
  std::uint64_t transactions_ = 0;
};

/// The driver's Port on such a wire.
/// @tparam WithLine whether the interrupt pin is connected.
template <bool WithLine>
class ChipPort {
 public:
  static constexpr bool has_interrupt_line = WithLine;

  /// @param wire must outlive the port.
  explicit ChipPort(SpiWire& wire) : wire_(&wire) {}

  bool interrupt_line_is_low() { return wire_->interrupt_line_is_low(); }
  void pause(std::uint16_t span_us) { wire_->pass(std::chrono::microseconds(span_us)); }
  /// Reading the clock takes a microsecond.
  std::uint32_t microseconds() {
    wire_->pass(std::chrono::microseconds(1));
    return static_cast<std::uint32_t>(
        std::chrono::duration_cast<std::chrono::microseconds>(wire_->now()).count());
  }

  class Transaction {
   public:
    Transaction(ChipPort& port, std::uint8_t first) : wire_(*port.wire_) {
      wire_.select();
      put(first);
    }
    Transaction(const Transaction&) = delete;
    Transaction& operator=(const Transaction&) = delete;
    ~Transaction() { release(); }
    void put(std::uint8_t byte) { wire_.exchange(byte); }
    std::uint8_t exchange(std::uint8_t byte) { return wire_.exchange(byte); }
    void send(const std::uint8_t* bytes, std::uint8_t count) {
      for (; count > 0; --count) {
        put(*bytes++);
      }
    }
    std::uint8_t* receive(std::uint8_t* bytes, std::uint8_t count) {
      for (; count > 0; --count) {
        *bytes++ = exchange(0);
      }
      return bytes;
    }
    void release() { wire_.deselect(); }
    void restart(std::uint8_t first) {
      wire_.select();
      put(first);
    }

   private:
    SpiWire& wire_;
  };

  class Uninterrupted {
   public:
    explicit Uninterrupted(ChipPort& /*port*/) {}
    Uninterrupted(const Uninterrupted&) = delete;
    Uninterrupted& operator=(const Uninterrupted&) = delete;
    ~Uninterrupted() {}  // NOLINT(modernize-use-equals-default): it has an effect elsewhere
  };

 private:
  SpiWire* wire_;
};

}  // namespace roio::sim

#endif
