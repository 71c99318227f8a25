/// ArduinoNode: a node of a Roio network on an Arduino. Roio.h makes class Roio of it.
#ifndef ROIO_ARDUINO_NODE_HPP
#define ROIO_ARDUINO_NODE_HPP

#include <roio/arduino_port.hpp>
#include <roio/mcp2515.hpp>
#include <roio/message.hpp>

namespace roio {

/// What a node has besides the least. Derive from it, change what differs, and give it to
/// RoioWith<>.
struct ArduinoOptions {
  /// Messages fetched ahead from the chip, which holds two itself; 1..127, 14 bytes each.
  static constexpr uint8_t rx_queue = 1;
  /// Messages that wait for the chip, which holds two and an urgent one itself; 0..127, 15 bytes
  /// each.
  static constexpr uint8_t tx_queue = 0;
  /// Whether the chip's INT is connected to a pin, the constructor's second argument: then a call
  /// that finds nothing costs no SPI.
  static constexpr bool interrupt_pin = false;
  /// For chips before revision B2, see docs/driver.md.
  static constexpr bool only_buffer_0 = false;
};

template <typename Options>
class ArduinoNode {
  struct DriverTraits : Mcp2515Traits {
    static constexpr bool only_buffer_0 = Options::only_buffer_0;
  };
  using Driver = Mcp2515<ArduinoPort<Options::interrupt_pin>, Options::rx_queue, Options::tx_queue,
                         DriverTraits>;

 public:
  // In a sketch everything has its name from here, since `roio` is what a sketch calls its node.
  using Address = roio::Address;
  using BitTiming = roio::BitTiming;
  using Counters = typename Driver::Counters;
  using Filters = Mcp2515Filters;
  using Interest = roio::Interest;
  using Message = roio::Message;
  using MessageClass = roio::MessageClass;
  using Mode = mcp2515::Mode;
  using Priority = roio::Priority;
  using State = Mcp2515State;
  using Status = roio::Status;

  explicit ArduinoNode(uint8_t chip_select_pin, uint8_t interrupt_pin = 0)
      : driver_(chip_select_pin, interrupt_pin),
        own_(),
        was_broadcast_(false),
        lastSubnet(0),
        lastAddress(0),
        lastLength(0),
        lastData() {}
  /// For `Roio roio = Roio(10);`: takes over the pins, before begin() only.
  ArduinoNode(ArduinoNode&& other) : ArduinoNode(other.driver_.port()) {}

  // --- beginning ---------------------------------------------------------------------------------

  /// The bit timing for a crystal and a rate: bitTiming<8000000, 500000>(). A pair that cannot be
  /// does not compile.
  template <uint32_t OscHz, uint32_t BitrateBps>
  static constexpr BitTiming bitTiming() {
    return bit_timing<OscHz, BitrateBps>();
  }

  /// Starts the chip, or starts it again. Takes 1 ms when all is well, 60 ms at most.
  /// @return ok; bad_argument: no valid address (subnet 0..31, node 0..254); bad_timing; no_chip;
  ///         wrong_mode. As Mcp2515::begin().
  Status begin(const BitTiming& timing, Address own, Mode mode = Mode::normal) {
    return begin(timing, own, mcp2515_filters_of(own), mode);
  }
  /// With filters of one's own: of an Interest (filtersOf()), or everything().
  Status begin(const BitTiming& timing, Address own, const Filters& filters,
               Mode mode = Mode::normal) {
    if (!is_valid_source(own)) {
      return Status::bad_argument;
    }
    own_ = own;
    driver_.port().begin();
    Mcp2515Config config(timing, filters);
    config.mode = mode;
    return driver_.begin(config);
  }
  static Filters everything() { return mcp2515_filters_of_everything(); }
  /// The filters for an Interest, up to 8 rules. When `exact` is false the chip lets through more
  /// than was asked for.
  static Filters filtersOf(const Interest& interest) {
    FilterProgram<8> program;
    Filters filters = mcp2515_filters_of(interest.own);
    if (compile(interest, program) == Status::ok) {
      filters = fit_mcp2515_in_order(program);
    } else {
      filters.in_order = false;  // begin() refuses it
    }
    return filters;
  }

  // --- messages ----------------------------------------------------------------------------------

  /// Looks after the chip. receive() and available() do it, too; a program that only sends calls
  /// this in each loop().
  /// @return ok; no_chip: the chip was reset or is not there: begin() again.
  Status poll() { return driver_.poll(); }

  /// The oldest message that has come.
  /// @return ok; empty; no_chip as poll().
  ROIO_NODISCARD Status receive(Message& message) {
    Frame frame;
    Status status = driver_.receive(frame);
    if (status == Status::ok) {
      status = to_message(frame, message);
    }
    return status;
  }

  /// Sends a message; this node is its source. Never waits.
  /// @return ok: it will be sent; full: try again after the next poll() or receive();
  ///         bad_argument: subnet above 31, length above 8; no_chip; wrong_mode: listening only.
  ROIO_NODISCARD Status send(Address destination, const uint8_t* data, uint8_t length,
                             Priority priority = Priority::normal) {
    Message message;
    message.header = Header{priority, MessageClass::message, destination, own_};
    message.length = length;
    for (uint8_t i = 0; i < max_data_length; ++i) {
      message.data[i] = i < length ? data[i] : 0;
    }
    Frame frame;
    const Status status = to_frame(message, frame);
    return status == Status::ok ? driver_.send(frame) : status;
  }

  const Counters& counters() const { return driver_.counters(); }
  State state() const { return driver_.state(); }
  bool running() const { return driver_.running(); }
  /// Whether the crystal is what the timing takes it for: Mcp2515::check_clock(). begin() must
  /// follow.
  Status checkClock(const BitTiming& timing, uint32_t osc_hz, uint32_t& measured_hz) {
    driver_.port().begin();
    return driver_.check_clock(Mcp2515Config(timing, mcp2515_filters_of(own_)), osc_hz,
                               measured_hz);
  }
  void errorCounters(uint8_t& transmit, uint8_t& receive) {
    driver_.read_error_counters(transmit, receive);
  }

  // --- as in the library of 2014 -----------------------------------------------------------------

  /// @param kbps 1000, 500, 250, 125 or 10, with a 16 MHz crystal.
  Status begin(uint16_t kbps, uint8_t address, uint8_t subnet) {
    return begin(original_bit_timing(kbps), Address{subnet, address});
  }
  /// How many messages read() has.
  uint8_t available() {
    driver_.poll();
    return driver_.fetched();
  }
  /// The oldest message, into the last... below.
  /// @return its first byte; 0 when it has none, or there is no message.
  uint8_t read() {
    Message message;
    if (receive(message) != Status::ok) {
      lastLength = 0;
      return 0;
    }
    lastSubnet = message.header.source.subnet;
    lastAddress = message.header.source.node;
    was_broadcast_ = message.header.destination.node == broadcast_node;
    lastLength = message.length;
    for (uint8_t i = 0; i < max_data_length; ++i) {
      lastData[i] = message.data[i];
    }
    return lastData[0];
  }
  bool isBroadcast() const { return was_broadcast_; }
  Status write(uint8_t data, uint8_t address, uint8_t subnet) {
    return write(&data, 1, address, subnet);
  }
  Status write(const uint8_t* data, uint8_t length, uint8_t address, uint8_t subnet) {
    return send(Address{subnet, address}, data, length);
  }
  Status broadcast(uint8_t data, uint8_t subnet) { return broadcast(&data, 1, subnet); }
  Status broadcast(const uint8_t* data, uint8_t length, uint8_t subnet) {
    return write(data, length, broadcast_node, subnet);
  }
  uint8_t status() { return 0; }
  Status changeMode(uint8_t) { return Status::ok; }
  void reset() {}

 private:
  explicit ArduinoNode(ArduinoPort<Options::interrupt_pin>& port)
      : ArduinoNode(port.chip_select_pin(), port.interrupt_pin()) {}

  Driver driver_;
  Address own_;
  bool was_broadcast_;

 public:
  uint8_t lastSubnet;   ///< Who sent the message that read() returned last.
  uint8_t lastAddress;  ///< And which of that subnet.
  uint8_t lastLength;   ///< 0..8.
  uint8_t lastData[max_data_length];
};

}  // namespace roio

#endif
