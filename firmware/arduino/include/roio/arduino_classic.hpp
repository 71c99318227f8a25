/// ClassicNode: what the Arduino library of 2014 had, beside what a node has now.
#ifndef ROIO_ARDUINO_CLASSIC_HPP
#define ROIO_ARDUINO_CLASSIC_HPP

#include <roio/arduino_node.hpp>

namespace roio {

/// A node whose chip select pin is told when it is made. With the names and the calls of 2014:
/// begin(kbps, address, subnet), available(), read(), write(), broadcast()...
class ClassicNode : public ArduinoNode<ArduinoPort<SetPin, NoPin>, ArduinoOptions> {
 public:
  explicit constexpr ClassicNode(uint8_t chip_select_pin)
      : ArduinoNode(chip_select_pin),
        lastSubnet(0),
        lastAddress(0),
        lastLength(0),
        lastData{},
        unsent(0),
        has_next_(false),
        was_broadcast_(false),
        next_() {}
  /// For `Roio roio = Roio(10);`: takes over the pin, before begin() only.
  ClassicNode(ClassicNode&& other) : ClassicNode(other.driver_.port().chip_select().number()) {}

  using ArduinoNode::changeMode;
  using ArduinoNode::receive;

  // What read() has read last.
  uint8_t lastSubnet;   ///< Who sent it: 0..31.
  uint8_t lastAddress;  ///< And which of that subnet: 0..254.
  uint8_t lastLength;   ///< 0..8; 0 also when there was nothing to read.
  uint8_t lastData[max_data_length];

  uint16_t unsent;  ///< Messages that write() and broadcast() gave up, modulo 65536.

  /// How many messages read() has: 0 or 1; the chip holds two more.
  uint8_t available() {
    if (!has_next_) {
      has_next_ = receive(next_) == Status::ok;
    }
    return has_next_ ? 1 : 0;
  }

  /// Takes the oldest message into the four above.
  /// @return its first byte; 0 when it has none, or when there is no message.
  uint8_t read() {
    const bool has_one = available() != 0;
    has_next_ = false;
    lastLength = has_one ? next_.length() : uint8_t{0};
    if (has_one) {
      lastSubnet = next_.source().subnet;
      lastAddress = next_.source().node;
      was_broadcast_ = next_.isBroadcast();
    }
    for (uint8_t i = 0; i < lastLength; ++i) {
      lastData[i] = next_.data()[i];
    }
    return lastLength != 0 ? lastData[0] : uint8_t{0};
  }

  /// Whether what read() has read was for everybody.
  bool isBroadcast() const { return was_broadcast_; }

  /// The oldest message, be it one that available() has seen.
  ROIO_NODISCARD Status receive(ArduinoMessage& message) {
    if (has_next_) {
      has_next_ = false;
      message = next_;
      return Status::ok;
    }
    return ArduinoNode::receive(message);
  }

  /// Sends one byte, or `length` of them (0..8). While the chip has no room it waits, 20 ms at
  /// most: sketches of that time did not ask. A message that is given up is counted in `unsent`.
  /// @return as send(); full: given up.
  Status write(uint8_t data, uint8_t address, uint8_t subnet) {
    return write(&data, 1, address, subnet);
  }
  Status write(const uint8_t* data, uint8_t length, uint8_t address, uint8_t subnet) {
    Status status = Status::full;
    for (uint8_t tries = 200; tries != 0 && status == Status::full; --tries) {
      status = send(ArduinoMessage(Address{subnet, address}, data, length));
      if (status == Status::full) {
        delayMicroseconds(100);
      }
    }
    if (status != Status::ok) {
      ++unsent;
    }
    return status;
  }

  /// The same to everybody in a subnet.
  Status broadcast(uint8_t data, uint8_t subnet) { return broadcast(&data, 1, subnet); }
  Status broadcast(const uint8_t* data, uint8_t length, uint8_t subnet) {
    return write(data, length, broadcast_node, subnet);
  }

  /// CANSTAT: the mode in bits 7 to 5; 0 in normal mode.
  uint8_t status() { return driver_.read_status(); }

  /// @param mode as in CANCTRL: 0x00 normal, 0x40 loopback, 0x60 listening only; others, sleep
  ///        among them, are refused.
  /// @return as changeMode(Mode).
  Status changeMode(uint8_t mode) {
    switch (mode) {
      case static_cast<uint8_t>(Mode::normal):
      case static_cast<uint8_t>(Mode::loopback):
      case static_cast<uint8_t>(Mode::listen_only):
        return ArduinoNode::changeMode(static_cast<Mode>(mode));
      default:
        return Status::bad_argument;
    }
  }

  /// Takes the chip off the bus; begin() comes after it.
  void reset() {
    has_next_ = false;
    driver_.stop();
  }

 private:
  bool has_next_;
  bool was_broadcast_;
  ArduinoMessage next_;
};

}  // namespace roio

#endif
