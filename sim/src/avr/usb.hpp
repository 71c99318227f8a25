/// AvrUsb: the USB device controller of an ATmega32U4, at full speed: control, bulk and interrupt
/// endpoints with one or two banks. Who is at the other end of the cable calls it, transaction by
/// transaction. Source: ATmega16U4/32U4 datasheet 7766, 21 and 22.
#ifndef ROIO_SIM_AVR_USB_HPP
#define ROIO_SIM_AVR_USB_HPP

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "avr/core.hpp"

namespace roio::sim {

class AvrUsb {
 public:
  /// What the device answers a transaction with.
  enum class Answer : std::uint8_t {
    ack,
    nak,    ///< Not now.
    stall,  ///< Not at all.
    none,   ///< No such endpoint is set up.
  };

  explicit AvrUsb(AvrCore& core);

  /// Called when the program does what a real device does not put up with.
  void on_violation(std::function<void(const char*)> listener) {
    violation_listener_ = std::move(listener);
  }
  /// Called when the program attaches the device (true) or detaches it, also by a restart.
  void on_attach(std::function<void(bool)> listener) { attach_listener_ = std::move(listener); }
  void reset();
  /// An interrupt was entered: USB's last as long as one of their flags is set.
  void interrupt_entered(const avr_int_vector_t& vector);

  // --- from the host -----------------------------------------------------------------------------

  /// @param address 0: until the program has set one.
  [[nodiscard]] bool listens_at(std::uint8_t address) const;

  void bus_reset();
  /// Every millisecond. @param number modulo 2048.
  void start_of_frame(std::uint16_t number);
  /// To endpoint 0, which takes it in any case.
  Answer setup(std::span<const std::uint8_t> bytes);
  Answer out(unsigned number, std::span<const std::uint8_t> bytes);
  /// @param number of the endpoint. @param bytes what it had to send, on ack.
  Answer in(unsigned number, std::vector<std::uint8_t>& bytes);

 private:
  static constexpr std::size_t endpoint_count = 7;

  using Bytes = std::vector<std::uint8_t>;
  struct Bank {
    Bytes bytes;
    std::size_t read = 0;  // of these, by the program
    bool full = false;     // OUT: the program's. IN: the host's.
  };
  struct Endpoint {
    std::uint8_t control = 0;     // UECONX
    std::uint8_t type = 0;        // UECFG0X
    std::uint8_t memory = 0;      // UECFG1X
    std::uint8_t enables = 0;     // UEIENX
    std::uint8_t flags = 0;       // UEINTX but RWAL, which follows from the bank
    std::array<Bank, 2> banks{};  // of a control endpoint: from the host, and to it
    std::size_t program_at = 0;   // the program's bank
    std::size_t host_at = 0;      // the host's next
  };
  static constexpr std::size_t from_host = 0;
  static constexpr std::size_t to_host = 1;

  [[nodiscard]] static bool is_control(const Endpoint& endpoint);
  [[nodiscard]] static bool is_in(const Endpoint& endpoint);
  [[nodiscard]] static bool is_enabled(const Endpoint& endpoint);
  [[nodiscard]] static std::size_t size_of(const Endpoint& endpoint);
  [[nodiscard]] static std::size_t bank_count(const Endpoint& endpoint);
  [[nodiscard]] static bool may_access(const Endpoint& endpoint);
  [[nodiscard]] static Bank& bank_to_read(Endpoint& endpoint);
  [[nodiscard]] static Bank& bank_to_write(Endpoint& endpoint);
  static void offer_bank(Endpoint& endpoint);
  static void clear_endpoint(Endpoint& endpoint);
  static void release_bank(Endpoint& endpoint);
  static void pass_bank(Endpoint& endpoint);
  static void clear_flags(Endpoint& endpoint, std::uint8_t cleared);

  Endpoint& selected();
  void violation(const char* what) const;
  void write_general(std::uint16_t address, std::uint8_t value);
  void write_device_flags(std::uint16_t address, std::uint8_t value);
  void write_reset(std::uint16_t address, std::uint8_t value);
  void write_endpoint(std::uint16_t address, std::uint8_t value);
  void write_flags(std::uint16_t address, std::uint8_t value);
  void write_data(std::uint16_t address, std::uint8_t value);
  std::uint8_t read_endpoint(std::uint16_t address);
  std::uint8_t read_data(std::uint16_t address);

  void update_attachment();
  void update_interrupts();
  void update(avr_int_vector_t& vector, std::uint8_t enable_bit, bool wanted);
  [[nodiscard]] std::uint8_t waiting_endpoints() const;

  AvrCore& core_;
  std::array<Endpoint, endpoint_count> endpoints_{};
  bool attached_ = false;
  avr_int_vector_t& general_vector_;
  avr_int_vector_t& endpoint_vector_;
  std::function<void(bool)> attach_listener_;
  std::function<void(const char*)> violation_listener_;
};

}  // namespace roio::sim

#endif
