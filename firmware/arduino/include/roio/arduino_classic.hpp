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
        fetched_(0),
        was_broadcast_(false),
        has_sent_(false),
        sent_before_(0),
        next_() {}
  /// For `Roio roio = Roio(10);`: takes over the pin, before begin() only.
  ClassicNode(ClassicNode&& other) : ClassicNode(other.driver_.port().chip_select().number()) {}

  using ArduinoNode::begin;
  using ArduinoNode::changeMode;
  using ArduinoNode::receive;

  // What read() has read last, or 0.
  uint8_t lastSubnet;   ///< Who sent it: 0..31.
  uint8_t lastAddress;  ///< And which of that subnet: 0..254.
  uint8_t lastLength;   ///< 0..8.
  uint8_t lastData[max_data_length];

  uint16_t unsent;  ///< Messages that write() and broadcast() gave up, modulo 65536.

  /// As ArduinoNode's.
  ROIO_IN_LINE Status begin(uint16_t kbps, uint8_t address, uint8_t subnet) {
    const Status status = ArduinoNode::begin(kbps, address, subnet);
    has_sent_ = false;
    sent_before_ = counters().sent;
    return status;
  }

  /// How many messages read() has: 0, 1 or 2; the chip may hold two more.
  uint8_t available() {
    while (fetched_ < most_fetched && ArduinoNode::receive(next_[fetched_]) == Status::ok) {
      ++fetched_;
    }
    return fetched_;
  }

  /// Takes the oldest message into the four above; they stay as they are when there is none.
  /// @return its first byte; 0 when it has none, or when there is no message.
  uint8_t read() {
    ArduinoMessage message;
    if (receive(message) != Status::ok) {
      return 0;
    }
    lastSubnet = message.source().subnet;
    lastAddress = message.source().node;
    lastLength = message.length();
    was_broadcast_ = message.isBroadcast();
    for (uint8_t i = 0; i < lastLength; ++i) {
      lastData[i] = message.data()[i];
    }
    return lastLength != 0 ? lastData[0] : uint8_t{0};
  }

  /// Whether what read() has read was for everybody.
  bool isBroadcast() const { return was_broadcast_; }

  /// The oldest message, be it one that available() has seen.
  ROIO_NODISCARD Status receive(ArduinoMessage& message) {
    if (fetched_ == 0) {
      return ArduinoNode::receive(message);
    }
    --fetched_;
    message = next_[0];
    next_[0] = next_[1];
    return Status::ok;
  }

  // By reference, so that roio.write(roio.read(), roio.lastAddress, roio.lastSubnet) has the sender
  // of what was just read, in whatever order a compiler evaluates the three.

  /// Sends one byte, or `length` of them; 9 and more are 8. While the chip has no room it waits, 20
  /// ms at most: sketches of that time did not ask. A message that is given up is counted in
  /// `unsent`.
  /// @return as send(); full: given up.
  template <typename Node, typename Subnet>
  ROIO_IN_LINE Status write(uint8_t data, const Node& address, const Subnet& subnet) {
    return deliver(&data, 1, static_cast<uint8_t>(address), static_cast<uint8_t>(subnet));
  }
  template <typename Node, typename Subnet>
  ROIO_IN_LINE Status write(const uint8_t* data, uint8_t length, const Node& address,
                            const Subnet& subnet) {
    return deliver(data, length, static_cast<uint8_t>(address), static_cast<uint8_t>(subnet));
  }

  /// The same to everybody in a subnet.
  template <typename Subnet>
  ROIO_IN_LINE Status broadcast(uint8_t data, const Subnet& subnet) {
    return write(data, broadcast_node, subnet);
  }
  template <typename Subnet>
  ROIO_IN_LINE Status broadcast(const uint8_t* data, uint8_t length, const Subnet& subnet) {
    return write(data, length, broadcast_node, subnet);
  }

  /// The chip's READ STATUS as it was in 2014: 01h and 02h while one and two messages can be read,
  /// 04h while one is to be sent, 08h from when the first one since begin() was sent. (Here
  /// available() fetches messages, three buffers send, and the chip's own flags have another use.)
  uint8_t status() {
    const uint8_t full = available();
    const uint8_t quick = driver_.read_status();
    has_sent_ = has_sent_ || counters().sent != sent_before_;
    uint8_t result = full == 0 ? 0 : full == 1 ? 0x01 : 0x03;
    if ((quick & mcp2515::QuickStatus::any_txreq) != 0) {
      result |= mcp2515::QuickStatus::txreq(mcp2515::second_buffer);
    }
    if (has_sent_) {
      result |= quick & mcp2515::QuickStatus::tx0if;
    }
    return result;
  }

  /// @param mode CANMODE_NORMAL, CANMODE_SLEEP, CANMODE_LOOP, CANMODE_LISTEN or CANMODE_CONFIG.
  ///        Before it sleeps or is configured, what is to be sent goes out, for 20 ms at most.
  /// @return as changeMode(Mode); bad_argument: another.
  Status changeMode(uint8_t mode) {
    constexpr uint8_t step = static_cast<uint8_t>(Mode::asleep);
    if (mode % step != 0 || mode > static_cast<uint8_t>(Mode::configuration)) {
      return Status::bad_argument;
    }
    Status status = Status::full;
    for (uint8_t tries = most_tries; tries != 0 && status == Status::full; --tries) {
      status = changeMode(static_cast<Mode>(mode));
      wait_while(status);
    }
    return status;
  }

  /// Takes the chip off the bus; begin() comes after it.
  void reset() {
    fetched_ = 0;
    driver_.stop();
  }

 private:
  static constexpr uint8_t most_fetched = 2;
  static constexpr uint8_t most_tries = 200;

  static void wait_while(Status status) {
    if (status == Status::full) {
      delayMicroseconds(100);
    }
  }

  Status deliver(const uint8_t* data, uint8_t length, uint8_t address, uint8_t subnet) {
    const uint8_t limited = length <= max_data_length ? length : max_data_length;
    Status status = Status::full;
    for (uint8_t tries = most_tries; tries != 0 && status == Status::full; --tries) {
      status = send(ArduinoMessage(Address{subnet, address}, data, limited));
      wait_while(status);
    }
    if (status != Status::ok) {
      ++unsent;
    }
    return status;
  }

  uint8_t fetched_;  // by available(): the first so many of next_
  bool was_broadcast_;
  bool has_sent_;
  uint16_t sent_before_;  // begin()
  ArduinoMessage next_[most_fetched];
};

}  // namespace roio

#endif
