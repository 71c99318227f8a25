/// UsbSerial: a board's USB and the PC at its other end. The PC sets the device up as an operating
/// system does, finds its serial port (CDC ACM), opens it, and moves bytes, in the time that full
/// speed takes. Source: USB 2.0, 5.8 and 9; USB CDC PSTN 1.2.
#ifndef ROIO_SIM_USB_SERIAL_HPP
#define ROIO_SIM_USB_SERIAL_HPP

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "avr/serial.hpp"
#include "avr/usb.hpp"

namespace roio::sim {

class UsbSerial final : public AvrSerial {
 public:
  explicit UsbSerial(AvrCore& core);

  /// Called when the program does what a real device does not put up with.
  void on_violation(std::function<void(const char*)> listener) {
    usb_.on_violation(std::move(listener));
  }

  void receive(std::span<const std::uint8_t> bytes) override;
  [[nodiscard]] std::size_t waiting() const override { return to_board_.size(); }
  [[nodiscard]] std::optional<double> bitrate_bps() const override { return std::nullopt; }
  bool hold(bool holds) override;
  void reset() override;
  void interrupt_entered(const avr_int_vector_t& vector) override {
    usb_.interrupt_entered(vector);
  }

 private:
  using Cycle = AvrCore::Cycle;
  using Bytes = std::vector<std::uint8_t>;

  /// What is asked of the device, in this order.
  enum class Step : std::uint8_t {
    settle,
    device_descriptor,
    address,
    configuration_head,
    configuration,
    configure,
    line_coding,
    open,  ///< DTR and RTS.
    running,
    refused,  ///< It answered no, or has no serial port.
  };
  enum class Stage : std::uint8_t { setup, data, status };

  /// A control transfer.
  struct Transfer {
    std::array<std::uint8_t, 8> setup{};
    Bytes data{};  // to the device, or from it
    Stage stage = Stage::setup;
  };

  void attached(bool is_attached);
  Cycle frame(Cycle when);
  Cycle transact(Cycle when);
  Cycle control(Cycle when);
  Cycle bulk(Cycle when);
  Cycle bulk_out(Cycle when);
  Cycle bulk_in(Cycle when);

  [[nodiscard]] Transfer transfer_of(Step step) const;
  void begin(Step step);
  void done();
  [[nodiscard]] bool find_port();
  [[nodiscard]] bool reads() const { return (transfer_.setup[0] & 0x80U) != 0; }
  [[nodiscard]] std::size_t length() const;
  AvrUsb::Answer transfer_data();
  AvrUsb::Answer transfer_status();

  AvrCore& core_;
  AvrUsb usb_;
  Step step_ = Step::settle;
  Transfer transfer_;
  std::uint16_t frames_ = 0;  // since it was attached
  bool held_ = false;
  bool out_turn_ = false;
  bool idle_ = false;  // the last transaction moved nothing
  unsigned in_endpoint_ = 0;
  unsigned out_endpoint_ = 0;
  std::uint8_t control_interface_ = 0;
  std::uint8_t address_ = 0;
  std::deque<std::uint8_t> to_board_;
  Bytes from_board_;  // that the PC has not handed on
};

}  // namespace roio::sim

#endif
