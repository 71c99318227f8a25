/// ArduinoNode: a node of a Roio network on an Arduino. Roio.h makes class Roio of it.
#ifndef ROIO_ARDUINO_NODE_HPP
#define ROIO_ARDUINO_NODE_HPP

#include <roio/arduino_message.hpp>
#include <roio/arduino_port.hpp>
#include <roio/arduino_setup.hpp>
#include <roio/mcp2515.hpp>

namespace roio {

/// What a node has besides the least. Derive from it, change what differs, and give it to
/// RoioWith<>.
struct ArduinoOptions {
  /// Messages that wait for the chip, which holds two and an urgent one itself; 0..127, 13 bytes
  /// each.
  static constexpr uint8_t tx_queue = 0;
  /// Messages fetched ahead by poll(); the chip holds two, and the node one; 0..127, 13 bytes each.
  static constexpr uint8_t rx_queue = 0;
  /// For chips before revision B2, see docs/internals/driver.md.
  static constexpr bool only_buffer_0 = false;
  /// Whether errors on the bus are counted, and the chip is looked at more closely.
  static constexpr bool diagnoses = false;
  /// Whether receive() hands out every frame that the filters let through, of other classes and of
  /// other protocols, too.
  static constexpr bool every_frame = false;
};

/// An address that its own type knows: begin() of a node that has one makes what the chip is to be
/// told when it is compiled. One that cannot be does not compile.
template <uint8_t Subnet, uint8_t Node>
struct FixedAddress : Address {
  static_assert(is_valid_source(Address{Subnet, Node}), "expected subnet 0..31 and node 0..254");
  constexpr FixedAddress() : Address{Subnet, Node} {}
};

/// @tparam Port an ArduinoPort.
template <typename Port, typename Options>
class ArduinoNode {
  struct Traits : Mcp2515Traits {
    static constexpr bool only_buffer_0 = Options::only_buffer_0;
    static constexpr bool diagnoses = Options::diagnoses;
    static constexpr bool all_kinds = Options::every_frame;
    /// Messages, from somebody who can be answered.
    static bool wants(const Mcp2515Frame& frame) {
      return Mcp2515Traits::wants(frame) && mcp2515::is_message(frame);
    }
  };

 protected:
  using Driver = Mcp2515<Port, Options::rx_queue, Options::tx_queue, Traits>;

 public:
  // In a sketch everything has its name from here, since `roio` is what a sketch calls its node.
  using Address = roio::Address;
  template <uint8_t Subnet, uint8_t Node>
  using FixedAddress = roio::FixedAddress<Subnet, Node>;
  using BitTiming = roio::BitTiming;
  using Counters = typename Driver::Counters;
  using Frame = roio::Frame;
  using Header = roio::Header;
  using FrameKind = roio::FrameKind;
  using Filters = Mcp2515FilterPair;
  using Interest = roio::Interest;
  using Message = ArduinoMessage;
  using MessageClass = roio::MessageClass;
  using Mode = mcp2515::Mode;
  using Priority = roio::Priority;
  using State = Mcp2515State;
  using Status = roio::Status;

  template <typename... Pin>
  explicit constexpr ArduinoNode(Pin... pin) : own_{0, 0}, driver_(pin...) {}

  // --- beginning ---------------------------------------------------------------------------------

  /// The bit timing for a crystal and a rate: bitTiming<8000000, 500000>(). A pair that cannot be
  /// does not compile.
  template <uint32_t OscHz, uint32_t BitrateBps>
  static constexpr BitTiming bitTiming() {
    return bit_timing<OscHz, BitrateBps>();
  }

  /// Starts the chip, or starts it again: roio.begin<16000000, 500000>(own). Takes 1 ms when all is
  /// well, 60 ms at most, or twice that on a bus that is never idle.
  /// @tparam OscHz the crystal's frequency, as printed on it.
  /// @return ok; bad_argument: no valid address (subnet 0..31, node 0..254), or a mode that rests;
  ///         no_chip; wrong_mode. As Mcp2515::begin().
  template <uint32_t OscHz, uint32_t BitrateBps>
  ROIO_IN_LINE Status begin(Address own, Mode mode = Mode::normal) {
    constexpr uint32_t cnf = mcp2515::Cnf::word(bit_timing<OscHz, BitrateBps>());
    if (!is_valid_source(own) || mcp2515::is_rest(mode)) {
      return Status::bad_argument;
    }
    take_address(own);
    return driver_.start(
        PlainSetup<cnf>(mcp2515_filters_of(own), mcp2515::Control::of(mode, false)));
  }
  /// The same, smaller: constexpr Roio::FixedAddress<0, 2> own{};
  template <uint32_t OscHz, uint32_t BitrateBps, uint8_t Subnet, uint8_t Node>
  ROIO_IN_LINE Status begin(FixedAddress<Subnet, Node> own, Mode mode = Mode::normal) {
    constexpr uint32_t cnf = mcp2515::Cnf::word(bit_timing<OscHz, BitrateBps>());
    if (mcp2515::is_rest(mode)) {
      return Status::bad_argument;
    }
    take_address(own);
    return driver_.start(FixedSetup<cnf, Subnet, Node>(mcp2515::Control::of(mode, false)));
  }
  /// With a bit timing of one's own.
  /// @return ok; bad_argument: no valid address (subnet 0..31, node 0..254), or a mode that rests;
  ///         bad_timing; no_chip; wrong_mode. As Mcp2515::begin().
  ROIO_IN_LINE Status begin(const BitTiming& timing, Address own, Mode mode = Mode::normal) {
    return begin_plain(mcp2515::Cnf::word(timing), own, mode);
  }
  /// With filters of one's own: filtersOf() an Interest, or everything().
  Status begin(const BitTiming& timing, Address own, const Filters& filters,
               Mode mode = Mode::normal) {
    if (!is_valid_source(own)) {
      return Status::bad_argument;
    }
    take_address(own);
    return driver_.begin(Mcp2515Config(timing, filters, mode));
  }
  static Filters everything() { return mcp2515_filters_of_everything(); }
  /// The filters for an Interest. When `exact` is false the chip lets through more than was asked
  /// for; in Mode::listen_only it lets everything through, whatever the filters are.
  /// @param filters written on ok only.
  /// @return ok; bad_argument: its own address is none; full: more than 8 rules.
  ROIO_NODISCARD static Status filtersOf(const Interest& interest, Filters& filters) {
    FilterProgram<8> program;
    const Status status = compile(interest, program);
    if (status == Status::ok) {
      filters = fit_mcp2515_in_order(program);
    }
    return status;
  }

  /// As in the library of 2014, and with its bit timing: for a 16 MHz crystal.
  /// @param kbps from 1000 on it means 1000, from 500 on 500, from 250 on 250, from 125 on 125, and
  ///        else 10.
  ROIO_IN_LINE Status begin(uint16_t kbps, uint8_t address, uint8_t subnet) {
    return begin_plain(original_cnf(kbps), Address{subnet, address}, Mode::normal);
  }

  // --- messages ----------------------------------------------------------------------------------

  /// Looks after the chip. receive() and available() do it, too; a program that only sends calls
  /// this in each loop().
  /// @return ok; no_chip: the chip was reset or is not there: begin() again.
  Status poll() { return driver_.poll(); }

  /// The oldest message that has come.
  /// @param message one on ok only; else anything.
  /// @return ok; empty; no_chip as poll().
  ROIO_NODISCARD Status receive(Message& message) { return driver_.receive(message.frame()); }

  /// Sends a message. Never waits.
  /// @param message its source becomes this node, also when it was not sent.
  /// @return ok: it will be sent; full: try again after the next poll() or receive();
  ///         bad_argument: subnet above 31, length above 8; no_chip; wrong_mode: listening only.
  ROIO_NODISCARD ROIO_IN_LINE Status send(Message& message) {
    // In line, or one and the same driver has two addresses for a compiler, and is told to
    // functions that would know it.
    return prepare(message.frame()) ? driver_.send(message.frame()) : Status::bad_argument;
  }
  ROIO_NODISCARD ROIO_IN_LINE Status send(Message&& message) { return send(message); }

  /// Any frame as it is on the bus, with Options::every_frame.
  ROIO_NODISCARD Status receive(Frame& frame) { return driver_.receive(frame); }
  /// @param frame sent as it is: what it has for a source, too.
  ROIO_NODISCARD Status send(const Frame& frame) { return driver_.send(frame); }

  /// What the identifier of an extended frame says.
  static Header headerOf(const Frame& frame) { return unpack_id(frame.id); }

  /// Everybody in a subnet, as a destination.
  static constexpr Address everybody(uint8_t subnet) { return broadcast_of(subnet); }

  // --- what goes on ------------------------------------------------------------------------------

  /// Whether the chip is at work; if not, begin() again.
  bool running() const { return driver_.running(); }
  ROIO_IN_LINE Counters counters() const { return driver_.counters(); }
  /// How many messages are in the receive queue.
  uint8_t fetched() const { return driver_.fetched(); }
  /// How many messages wait in the send queue, and in the chip.
  uint8_t waiting() const { return static_cast<uint8_t>(driver_.waiting() + driver_.in_flight()); }
  /// Asks the chip: active, warning (an error counter above 95), passive (above 127) or bus_off.
  State state() { return driver_.read_state(); }
  /// The chip's error counters.
  void errorCounters(uint8_t& transmit, uint8_t& receive) {
    driver_.read_error_counters(transmit, receive);
  }
  /// Whether the crystal is what the timing takes it for: Mcp2515::check_clock(). begin() must
  /// follow.
  Status checkClock(const BitTiming& timing, uint32_t osc_hz, uint32_t& measured_hz) {
    driver_.port().begin();
    return driver_.check_clock(Mcp2515Config(timing, mcp2515_filters_of(own_)), osc_hz,
                               measured_hz);
  }
  /// Whether the chip's INT is connected to the pin that was named for it. If not, each call asks
  /// the chip, and nothing else changes. Known from begin() on, and noticed when a wire comes off
  /// later.
  bool interruptIsConnected() const { return driver_.line_is_on(); }
  /// Whether the chip's pins RX0BF and RX1BF are driven, and low while their buffer is full, for a
  /// light at each. Not driven after begin().
  void showFullBuffers(bool shows = true) { driver_.show_full_buffers(shows); }

  // --- other modes -------------------------------------------------------------------------------

  /// Another mode: Mcp2515::change_mode().
  ROIO_NODISCARD Status changeMode(Mode mode) { return driver_.change_mode(mode); }

  /// Puts the chip to sleep, when all is sent: some uA, until wake(). receive() until it is empty
  /// before. The next message on the bus wakes the chip and makes INT low, for a processor that
  /// sleeps, too; but the chip loses that message, and then only listens, until wake().
  /// @return ok, also when the bus has woken it already; full: something is still to be sent:
  /// poll(),
  ///         and try again; no_chip, wrong_mode: begin() again.
  ROIO_NODISCARD Status sleep() { return changeMode(Mode::asleep); }
  /// Whether it still sleeps: the bus may have woken it.
  bool isAsleep() { return driver_.is_asleep(); }
  /// Takes part again, be it asleep or woken by the bus: takes 1 ms and what the crystal needs to
  /// start, or 100 ms when all goes wrong.
  /// @return ok; no_chip: it has been without power, or does not wake; wrong_mode: the bus is never
  ///         quiet: begin() again.
  ROIO_NODISCARD Status wake(Mode mode = Mode::normal) { return changeMode(mode); }

  // --- words -------------------------------------------------------------------------------------

  /// What a status says, for Serial.println(): a short phrase in lower case.
  static const __FlashStringHelper* toString(Status status) {
    const char* text = PSTR(ROIO_STATUS_TEXTS);
    for (uint8_t number = text_number(status); number != 0; --number) {
      while (pgm_read_byte(text++) != 0) {
      }
    }
    return reinterpret_cast<const __FlashStringHelper*>(text);
  }

 private:
  /// @return whether it can be sent.
  bool prepare(Mcp2515Frame& frame) const {
    mcp2515::put_source(own_, frame);
    return mcp2515::can_be_sent(frame);
  }
  // Chosen among numbers, which a compiler sees through.
  static ROIO_IN_LINE uint32_t original_cnf(uint16_t kbps) {
    constexpr uint32_t at_1000 = mcp2515::Cnf::word(original_bit_timing(1000));
    constexpr uint32_t at_500 = mcp2515::Cnf::word(original_bit_timing(500));
    constexpr uint32_t at_250 = mcp2515::Cnf::word(original_bit_timing(250));
    constexpr uint32_t at_125 = mcp2515::Cnf::word(original_bit_timing(125));
    constexpr uint32_t at_10 = mcp2515::Cnf::word(original_bit_timing(10));
    return kbps >= 1000  ? at_1000
           : kbps >= 500 ? at_500
           : kbps >= 250 ? at_250
           : kbps >= 125 ? at_125
                         : at_10;
  }
  ROIO_IN_LINE Status begin_plain(uint32_t cnf, Address own, Mode mode) {
    if (!is_valid_source(own) || mcp2515::is_rest(mode)) {
      return Status::bad_argument;
    }
    if (cnf == 0) {
      return Status::bad_timing;
    }
    take_address(own);
    constexpr uint32_t mask = mcp2515_filters_of(Address{0, 0}).mask;
    const Mcp2515Config config(cnf, mask, mcp2515_filters_of(own).filter[0],
                               mcp2515_filters_of(own).filter[1],
                               mcp2515::Control::of(mode, false));
    return driver_.start(config);
  }
  /// And the pins.
  ROIO_IN_LINE void take_address(Address own) {
    own_ = own;
    driver_.port().begin();
  }

  Address own_;

 protected:
  Driver driver_;
};

}  // namespace roio

#endif
