/// AvrSpi: the SPI of an AVR as a master, in its true time: a byte takes 8 clocks of 2 to 128
/// cycles, from the end of the instruction that writes SPDR. Source: ATmega328P datasheet, 18
/// (the others' are the same, registers included). What counts cycles in place of asking for SPIF
/// finds it as on silicon: at half the clock a byte that is written in cycle 0 can be read from
/// cycle 17 on and the next be written from cycle 18 on; one written in cycle 17 does not go out.
/// Source: measured on an Arduboy's ATmega32U4, tiberiusbrown/Ardens pull request 134.
#ifndef ROIO_SIM_AVR_SPI_HPP
#define ROIO_SIM_AVR_SPI_HPP

#include <cstdint>
#include <functional>
#include <optional>

#include "avr/core.hpp"

namespace roio::sim {

class AvrSpi {
 public:
  explicit AvrSpi(AvrCore& core);

  /// The end of the byte under way; the core runs no further than that.
  [[nodiscard]] std::optional<AvrCore::Cycle> end() const { return end_; }
  /// The byte as the wire carries it, most significant bit first.
  [[nodiscard]] std::uint8_t out() const { return in_wire_order(out_); }
  /// CPOL and CPHA.
  [[nodiscard]] unsigned mode() const;
  /// The byte is over, and this came in.
  void finish(std::uint8_t in);
  void reset();
  /// Called when SPDR is written or read too early.
  void on_violation(std::function<void(const char*)> listener) { violated_ = std::move(listener); }
  /// Asked before a transfer: whether something pulls SS low while it is an input.
  void set_slave_select(std::function<bool()> is_low) { slave_select_is_low_ = std::move(is_low); }

 private:
  void write_control(std::uint16_t address, std::uint8_t value);
  void write_status(std::uint16_t address, std::uint8_t value);
  void write_data(std::uint16_t address, std::uint8_t value);
  std::uint8_t read_status(std::uint16_t address);
  std::uint8_t read_data(std::uint16_t address);
  void data_accessed();
  void violation(const char* what) const;
  [[nodiscard]] std::uint8_t in_wire_order(std::uint8_t byte) const;

  AvrCore& core_;
  avr_int_vector_t& vector_;
  std::optional<AvrCore::Cycle> end_;
  AvrCore::Cycle free_at_ = 0;  // from here on a write takes effect
  std::uint8_t out_ = 0;
  std::uint8_t received_ = 0;
  bool is_unread_ = false;  // what was received last
  std::uint8_t seen_ = 0;   // flags that were set when SPSR was read
  std::function<void(const char*)> violated_;
  std::function<bool()> slave_select_is_low_;
};

}  // namespace roio::sim

#endif
