/// AvrUart: a USART of an AVR in asynchronous mode, in its true time, double-buffered both ways.
/// Source: ATmega328P datasheet, 19.
#ifndef ROIO_SIM_AVR_UART_HPP
#define ROIO_SIM_AVR_UART_HPP

#include <cstdint>
#include <deque>
#include <optional>

#include "avr/serial.hpp"

namespace roio::sim {

class AvrUart final : public AvrSerial {
 public:
  AvrUart(AvrCore& core, std::uint16_t base);

  void receive(std::span<const std::uint8_t> bytes) override;
  [[nodiscard]] std::size_t waiting() const override { return line_.size(); }
  [[nodiscard]] std::optional<double> bitrate_bps() const override;
  bool hold(bool /*holds*/) override { return false; }
  void reset() override;
  void interrupt_entered(const avr_int_vector_t& vector) override;

 private:
  struct Received {
    std::uint8_t byte = 0;
    bool after_overrun = false;
  };

  void write_status(std::uint16_t address, std::uint8_t value);
  void write_control(std::uint16_t address, std::uint8_t value);
  void write_data(std::uint16_t address, std::uint8_t value);
  std::uint8_t read_status(std::uint16_t address);
  std::uint8_t read_data(std::uint16_t address);

  void start_sending(std::uint8_t byte, AvrCore::Cycle cycle);
  AvrCore::Cycle sent(AvrCore::Cycle when);
  void listen();
  AvrCore::Cycle line_event(AvrCore::Cycle when);
  void start_bit(AvrCore::Cycle when);
  void arrived();
  void flush();

  [[nodiscard]] AvrCore::Cycle bit_cycles() const;
  [[nodiscard]] unsigned bits_before_stop() const;
  [[nodiscard]] AvrCore::Cycle frame_cycles() const;
  [[nodiscard]] bool has(std::uint16_t address, unsigned bit) const;
  void set_status(unsigned bit, bool on) const;

  AvrCore& core_;
  std::uint16_t status_;    // UCSRnA
  std::uint16_t control_;   // UCSRnB
  std::uint16_t format_;    // UCSRnC
  std::uint16_t rate_low_;  // UBRRnL, UBRRnH
  std::uint16_t data_;      // UDRn
  bool shifting_out_ = false;
  bool line_busy_ = false;                   // a timer runs for the line to the receiver
  bool heard_ = false;                       // the receiver was on when the start bit came
  bool overrun_ = false;                     // the next frame comes after a lost one
  std::optional<std::uint8_t> next_out_;     // in the data register
  std::optional<std::uint8_t> shifting_in_;  // on the line to the receiver
  std::optional<Received> held_;             // a third, in the receiver's shift register
  avr_int_vector_t& received_vector_;
  avr_int_vector_t& sent_vector_;
  avr_int_vector_t& empty_vector_;
  AvrCore::Cycle out_end_ = 0;
  AvrCore::Cycle line_free_ = 0;
  std::deque<std::uint8_t> line_;  // waits for the line
  std::deque<Received> buffer_;    // the receiver's: two at most
};

}  // namespace roio::sim

#endif
