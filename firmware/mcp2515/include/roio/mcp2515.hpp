/// Mcp2515: the driver of the MCP2515 CAN controller. Frames come out in the order in which they
/// were on the bus and go out in the order in which they were given, none twice, and what the
/// hardware loses is counted.
///
///   roio::Mcp2515<MyPort> can;
///   roio::Mcp2515Config config = {roio::bit_timing<16000000, 500000>(),
///                                 roio::mcp2515_filters_of(roio::Address{0, 2})};
///   if (can.begin(config) != roio::Status::ok) ...
///   for (;;) {
///     roio::Frame frame;
///     if (can.receive(frame) == roio::Status::ok) ...
///     if (can.send(reply) == roio::Status::full) ...    // try again later
///     if (can.poll() != roio::Status::ok) ...           // begin() again
///   }
///
/// **When to call.** The chip holds two received frames. Call poll() (with RxQueue 0: receive()) at
/// least once in the time that two frames take on the bus, less the time to read one (134 us at 1
/// Mbit/s, 268 us at 500 kbit/s, without data), or frames are lost: the chip says so, and it is
/// counted. With an interrupt line a call costs no SPI while nothing has happened. Not from an
/// interrupt and the main program both.
///
/// **Cost.** For a frame with 8 bytes, in SPI bytes and transactions: received in a run or with an
/// interrupt line 16 in 2, the first one found by polling 18 in 3; sent 15 in 2, and 17 in 3 while
/// the chip may still have others. A frame with n bytes fewer costs n fewer. A call that finds
/// nothing costs 2 in 1, or none with an interrupt line. No call waits for the bus. An interrupt
/// line that is found not to work is left alone until the next begin(), and polling goes on.
///
/// No heap, no exceptions, no global state, no floating point. What a template argument switches
/// off takes no flash. The Port is the only way to hardware: see PortExample below. Source: MCP2515
/// datasheet DS20001801; errata DS80179.
#ifndef ROIO_MCP2515_HPP
#define ROIO_MCP2515_HPP

#include <stdint.h>

#include <roio/bit_timing.hpp>
#include <roio/filter_mcp2515.hpp>
#include <roio/frame.hpp>
#include <roio/header.hpp>
#include <roio/mcp2515_config.hpp>
#include <roio/mcp2515_frame.hpp>
#include <roio/mcp2515_line.hpp>
#include <roio/mcp2515_order.hpp>
#include <roio/mcp2515_outcomes.hpp>
#include <roio/mcp2515_queue.hpp>
#include <roio/mcp2515_registers.hpp>
#include <roio/status.hpp>

/// On an AVR a call is smaller than what it calls, from the second on; the optimiser of a linker
/// that sees all callers thinks otherwise.
#if defined(__AVR__)
#define ROIO_MCP2515_OUT_OF_LINE __attribute__((noinline))
#else
#define ROIO_MCP2515_OUT_OF_LINE
#endif

namespace roio {

// What a Port has to look like. The driver constructs one from the arguments of its own
// constructor.
//
//   struct PortExample {
//     static constexpr bool has_interrupt_line = true;
//     bool interrupt_line_is_low();
//     void pause(uint16_t microseconds);  // that long at least, also with interrupts off
//     uint32_t microseconds();  // free running, wraps at 2^32; for check_clock() alone
//     class Transaction {       // chip select is low as long as one lives, or until release()
//      public:
//       Transaction(PortExample&, uint8_t first);        // the first byte to be sent
//       void put(uint8_t byte);                          // sends one
//       void send(const uint8_t* bytes, uint8_t count);  // 1 or more
//       uint8_t exchange(uint8_t byte);                  // the same, and receives one
//       uint8_t* receive(uint8_t* bytes, uint8_t count); // 1 or more; returns what is behind them
//       void release();                // chip select high, early
//       void restart(uint8_t first);   // after that: low again, and a first byte
//       ~Transaction();
//     };
//     class Uninterrupted {     // while one lives, nothing else runs: interrupts are off
//      public:
//       explicit Uninterrupted(PortExample&);
//       ~Uninterrupted();
//     };
//   };
//
// SPI mode 0,0 at 10 MHz at most (mode 1,1 would send a frame twice, errata item 5).

/// What became of a frame that send() took.
enum class TxOutcome : uint8_t {
  sent,     ///< On the bus, and acknowledged by at least one node.
  failed,   ///< One shot, and it lost arbitration, met an error or was not acknowledged.
  aborted,  ///< Taken back by abort(): not sent.
  unknown,  ///< The chip lost its memory while it had the frame; it may have been sent.
};

/// Fault confinement, as EFLG had it when it was last looked at.
enum class Mcp2515State : uint8_t { active, warning, passive, bus_off };

/// Counted since construction, modulo the type's range. Each loss is in one of these.
template <typename Count>
struct Mcp2515Counters {
  Count received;        ///< Frames taken from the chip for the program.
  Count foreign;         ///< Frames that Traits::wants() did not want, dropped.
  Count overflows;       ///< Times that frames were lost because both buffers were full: at least
                         ///< one each; the chip cannot say how many.
  Count sent;            ///< Frames sent and acknowledged.
  Count not_sent;        ///< Frames taken back or failed.
  Count unknown;         ///< Frames that the chip had when it lost its memory.
  Count message_errors;  ///< Times that errors on the bus were seen: at least one each.
  Count bus_offs;        ///< Times that the chip was found bus-off.
  Count chip_losses;  ///< Times that the chip was reset, unplugged, or answered nonsense: up to two
                      ///< received frames went with it each time.
  Count discarded;    ///< Frames read and thrown away because the chip was lost meanwhile.
  Count line_losses;  ///< Times that the interrupt line was found not connected. No frame went with
                      ///< it, but since then, and until begin() comes again, the driver polls.
};

/// What to leave in. Derive from it, change what differs, pass it as Traits.
struct Mcp2515Traits {
  using Count = uint16_t;
  /// Frames of all kinds can be sent, and all that the chip lets through are handed out.
  static constexpr bool all_kinds = false;
  /// Without all_kinds: which of the frames that the chip lets through are handed out. The others
  /// are counted as foreign.
  static bool wants(const Mcp2515Frame& frame) { return frame.is_extended() && !frame.is_remote(); }
  /// Only transmit buffer 0 is used: for chips before revision B2, which may spoil the others when
  /// told to send while they receive (errata item 2). An urgent frame then waits for the one that
  /// the chip has.
  static constexpr bool only_buffer_0 = false;
  /// Six normal frames follow one another without a gap before the chip runs empty, in place of
  /// two: for a node that fills the bus. Costs 2 SPI bytes more with each frame.
  static constexpr bool back_to_back = false;
  /// Whether an interrupt line may turn out not to be connected. If not, the Port has to see to it
  /// that a line that is off counts as low.
  static constexpr bool doubts_line = true;
  /// Whether anybody wants to know what became of each frame. If not, there are no tokens, no
  /// abort() and no one-shot mode, and the driver does not ask the chip just for that.
  static constexpr bool reports_outcomes = false;
  /// Whether errors on the bus are counted, and the state that they lead to is known without a
  /// look. If not, the counters message_errors and bus_offs stay 0, and what the chip held when
  /// begin() is called again is not counted as discarded.
  static constexpr bool diagnoses = true;
  /// Called from send(), poll(), receive(), abort(), begin() and check_clock(), with the token that
  /// send() was given. Must not call the driver. Only with reports_outcomes.
  void on_outcome(uint8_t, TxOutcome) {}
  /// Which frames abort() takes back, by their tokens. Called from abort(), and until in_flight()
  /// is 0 from what on_outcome() is called from. Must not call the driver. Only with
  /// reports_outcomes.
  static bool is_over(uint8_t) { return true; }
};

/// @tparam RxQueue frames that poll() fetches ahead of receive(), 0..127, 13 bytes each. 0: each
///         receive() reads one from the chip.
/// @tparam TxQueue frames that wait beside those in the chip (two normal ones and an urgent one),
///         0..127, 13 bytes each (14 with reports_outcomes). 0: send() says full when the chip has
///         no room.
template <typename Port, uint8_t RxQueue = 2, uint8_t TxQueue = 2, typename Traits = Mcp2515Traits>
class Mcp2515 {
 public:
  using Counters = Mcp2515Counters<typename Traits::Count>;

  template <typename... Arguments>
  explicit constexpr Mcp2515(Arguments&&... arguments)
      : parts_(static_cast<Arguments&&>(arguments)...),
        counters_(),
        status_(0),
        error_flags_(0),
        control_(0),
        calls_(0) {}

  Mcp2515(const Mcp2515&) = delete;
  Mcp2515& operator=(const Mcp2515&) = delete;
  ~Mcp2515() = default;

  /// Resets the chip and sets it up; what it held is gone (frames that it was to send are reported
  /// as unknown). What waits in the queues stays. May be called again at any time, and must be when
  /// poll() says that the chip is lost. Takes 1 ms when all is well; at most 60 ms for a chip that
  /// does not answer, and as long again for a bus that is never idle for 11 bits. (SPI at 1 MHz.)
  /// @return ok. bad_timing: the chip cannot run at this timing; bad_argument: configuration or
  ///         sleep mode, or one_shot without reports_outcomes; after these two nothing was touched.
  ///         no_chip: no answer, or not what was written. wrong_mode: the mode was not entered (the
  ///         bus is stuck, or has no transceiver).
  ROIO_NODISCARD Status begin(const Mcp2515Config& config);
  /// The same, of a configuration that is known to be right: does not look for bad_timing and
  /// bad_argument.
  /// @tparam Setup Mcp2515Config, or what has its operator[] and control().
  template <typename Setup>
  ROIO_NODISCARD Status start(const Setup& setup);

  /// Fetches what has come in (with RxQueue 0 that is receive()'s alone), hands over what waits,
  /// looks after errors. Bounded: at most RxQueue + 2 frames and a handful of registers.
  /// @return ok; no_chip: the chip was reset or is not there, or begin() has not succeeded yet.
  Status poll();

  /// The oldest frame received. With a queue, looks at the chip only when the queue is empty.
  /// @param frame a frame on ok only.
  /// @return ok; empty; no_chip as for poll().
  ROIO_NODISCARD Status receive(Frame& frame);
  /// The same, as the chip has it.
  ROIO_NODISCARD Status receive(Mcp2515Frame& frame);

  /// Queues a frame. Urgent ones (bit 28 of the identifier is 0) leave before normal ones, first in
  /// first out within each. Up to two normal frames are in the chip already and may go between two
  /// urgent ones.
  /// @param frame copied.
  /// @param token comes back with the frame's outcome.
  /// @return ok: it will be sent, and reported; full: nothing was stored, try again after poll();
  ///         bad_argument: an identifier, length or kind that may not be sent; wrong_mode: listen
  ///         only; no_chip: begin() has not succeeded, or the chip is lost.
  ROIO_NODISCARD Status send(const Frame& frame, uint8_t token = 0);
  /// The same, as the chip has it.
  /// @param frame one that may be sent: not looked at.
  ROIO_NODISCARD Status send(const Mcp2515Frame& frame, uint8_t token = 0);

  /// Enters another mode. normal, listen_only and loopback: as soon as the bus is idle for 11 bits;
  /// waits for it as begin() does. In listen_only the chip's filters do not hold (10.3).
  /// asleep and configuration: the chip leaves the bus and keeps its setup; running() is false, and
  /// the calls above say no_chip, until change_mode() takes it up again, or begin() starts it anew.
  /// Asleep it is woken by the next frame on the bus, which is lost, and pulls its interrupt pin,
  /// or by change_mode(), which has to come in any case: woken by the bus it only listens.
  /// @return ok; full: asleep or configuration, and a frame is still to be sent: poll(), try again;
  ///         no_chip; wrong_mode: not entered: begin() again.
  ROIO_NODISCARD Status change_mode(mcp2515::Mode mode);
  /// Whether the chip sleeps: one register is read. No longer, once the bus has woken it.
  bool is_asleep() {
    return mcp2515::Control::mode_of(read_register(Register::canstat)) == mcp2515::Mode::asleep;
  }

  /// Takes the chip off the bus, into configuration mode; what it held is gone as with begin().
  /// @return ok; no_chip: no answer.
  Status stop();

  /// Takes back all frames that are not yet on the wire and that Traits::is_over(). Each is
  /// reported, as aborted or, if it was too late, as sent; poll() until in_flight() is 0. Meanwhile
  /// send() says full. Of the others those that the chip has go out after that, in their order.
  template <typename T = Traits>
  void abort();

  /// How many frames are in the chip to be sent, as far as was last seen.
  uint8_t in_flight() const {
    // Bits 2, 4 and 6: times 40h, 10h and 4 each comes to bit 8, and there they add up.
    return static_cast<uint8_t>((requested() * 0x54U) >> 8) & 3U;
  }
  /// How many received frames receive() has without looking at the chip.
  uint8_t fetched() const { return rx_queue().size(); }
  /// How many wait for the chip.
  uint8_t waiting() const { return tx_queue().size(); }

  /// Reads the chip's error counters.
  void read_error_counters(uint8_t& transmit, uint8_t& receive);

  /// Finds out whether the oscillator is what `config.timing` takes it for, by sending a frame from
  /// the chip to itself and timing it. Nothing goes to the bus. Ends in configuration mode: begin()
  /// comes after it. Takes three frames of 131 bits and two resets; twelve times as long as these
  /// should take, and 120 ms, at most.
  /// @param osc_hz what the timing was computed for, 1,000,000 or more.
  /// @param measured_hz what the oscillator is, to some percent; 0 when it is slower than one
  ///        twelfth, and unless ok or wrong_clock.
  /// @return ok: within one eighth; wrong_clock; bad_argument: osc_hz too low; else as begin().
  ROIO_NODISCARD Status check_clock(const Mcp2515Config& config, uint32_t osc_hz,
                                    uint32_t& measured_hz);

  bool running() const { return (status_ & QuickStatus::tx0if) != 0; }
  /// Whether the interrupt line is there and, as far as is known, works; if not, the driver polls.
  bool line_is_on() const { return parts_.is_on(); }
  /// As last seen; active for ever without Traits::diagnoses.
  Mcp2515State state() const { return state_of(error_flags_); }
  /// As it is now: one register is read.
  Mcp2515State read_state() { return state_of(read_register(Register::eflg)); }
  /// READ STATUS, as it is now. The three TXnIF are always set in a chip that is at work.
  uint8_t read_status();
  /// Whether the pins RX0BF and RX1BF are driven, and low while their buffer is full; not driven
  /// after begin().
  void show_full_buffers(bool shows) {
    write_register(Register::bfpctrl, shows ? mcp2515::pins_show_buffers : uint8_t{0});
  }
  ROIO_MCP2515_IN_LINE Counters counters() const {
    Counters counters = counters_;
    if (!Traits::reports_outcomes) {
      // Counted when the chip was given them; what has not ended otherwise has ended well.
      counters.sent =
          static_cast<typename Traits::Count>(counters.sent - counters.unknown - in_flight());
    }
    return counters;
  }
  Port& port() { return parts_; }
  Traits& traits() { return parts_; }

 private:
  using Instruction = mcp2515::Instruction;
  using Register = mcp2515::Register;
  using QuickStatus = mcp2515::QuickStatus;
  using Transaction = typename Port::Transaction;
  /// An access to the registers from one on.
  struct RegisterAccess : Transaction {
    ROIO_MCP2515_IN_LINE RegisterAccess(Port& port, Instruction instruction, Register address)
        : Transaction(port, static_cast<uint8_t>(instruction)) {
      this->put(static_cast<uint8_t>(address));
    }
    RegisterAccess(const RegisterAccess&) = delete;
    RegisterAccess& operator=(const RegisterAccess&) = delete;
    // In line, which a defaulted one is not always: NOLINTNEXTLINE(modernize-use-equals-default)
    ROIO_MCP2515_IN_LINE ~RegisterAccess() {}
  };

  using Waiting = mcp2515::Waiting<Traits::reports_outcomes>;
  static_assert(!(Traits::only_buffer_0 && Traits::back_to_back),
                "with buffer 0 alone nothing goes back to back");
  using Order = mcp2515::TxOrder<Traits::only_buffer_0  ? mcp2515::TxPlaces::one
                                 : Traits::back_to_back ? mcp2515::TxPlaces::six
                                                        : mcp2515::TxPlaces::two>;
  using Requests = mcp2515::Requests<Traits::reports_outcomes>;
  using Line = mcp2515::Line<Port::has_interrupt_line, Traits::doubts_line>;
  using RxRing = mcp2515::Ring<Mcp2515Frame, RxQueue>;
  using TxRing = mcp2515::Ring<Waiting, TxQueue>;
  /// Bases, since most often these are empty: a member takes a byte even so.
  struct Parts : Port, Traits, Requests, Order, Line, RxRing, TxRing {
    template <typename... Arguments>
    explicit constexpr Parts(Arguments&&... arguments)
        : Port(static_cast<Arguments&&>(arguments)...),
          Traits(),
          Requests(),
          Order(),
          Line(),
          RxRing(),
          TxRing() {}
  };

  static bool is_urgent(const Mcp2515Frame& frame) {
    return (frame.bytes[0] & mcp2515::priority_bit) == 0 &&
           (!Traits::all_kinds || frame.is_extended());
  }
  bool is_sendable(const Frame& frame) const {
    return is_valid(frame) && frame.kind != FrameKind::error &&
           (Traits::all_kinds || frame.kind == FrameKind::extended);
  }

  static Mcp2515State state_of(uint8_t error_flags);

  // the chip's registers
  // Arguments in one order, so that a call from one to the other moves none.
  ROIO_MCP2515_OUT_OF_LINE uint8_t access_register(Register address, uint8_t value,
                                                   Instruction instruction);
  ROIO_MCP2515_OUT_OF_LINE uint8_t read_register(Register address);
  ROIO_MCP2515_OUT_OF_LINE void write_register(Register address, uint8_t value);
  ROIO_MCP2515_OUT_OF_LINE uint8_t mode_differs_from(uint8_t control);
  void modify_register(Register address, uint8_t mask, uint8_t value);
  ROIO_MCP2515_IN_LINE uint8_t read_quick_status() {
    Transaction transaction(port(), static_cast<uint8_t>(Instruction::read_status));
    return transaction.exchange(0);
  }
  template <typename Setup>
  bool exchange_setup(const Setup& setup);

  // changing modes
  bool await(mcp2515::Mode mode);
  void prepare_sleep();
  bool sleeps_or_slept();
  void end_sleep();

  // starting
  bool enters(uint8_t control);
  ROIO_MCP2515_OUT_OF_LINE uint8_t reach(uint8_t control);
  template <typename Setup>
  bool configure(const Setup& setup);
  bool reset_chip();
  void count_what_is_forgotten();
  void load_clock_frames();
  uint32_t time_clock_frames(uint32_t limit_us);

  // what READ STATUS shows
  uint8_t nonsense_in(uint8_t quick) const;
  ROIO_MCP2515_OUT_OF_LINE void look();
  ROIO_MCP2515_OUT_OF_LINE uint8_t take_in(uint8_t quick);
  ROIO_MCP2515_OUT_OF_LINE uint8_t look_once();

  // the interrupt line
  Line& line() { return parts_; }
  void try_line();
  bool line_follows(bool low);
  void lose_line();

  // receiving
  RxRing& rx_queue() { return parts_; }
  const RxRing& rx_queue() const { return parts_; }
  uint8_t received() const { return status_ & QuickStatus::any_rx; }
  bool look_for_frame();
  bool fetch(Mcp2515Frame& frame);
  bool read_rx_buffer(bool first, Mcp2515Frame& frame);

  // sending
  uint8_t requested() const { return status_ & QuickStatus::any_txreq; }
  bool give_to_chip(const Mcp2515Frame& frame, uint8_t token);
  Status enqueue(const Mcp2515Frame& frame, uint8_t token);
  void pump();
  bool load(const Mcp2515Frame& frame, uint8_t token);
  Requests& requests() { return parts_; }
  Order& order() { return parts_; }
  TxRing& tx_queue() { return parts_; }
  const TxRing& tx_queue() const { return parts_; }
  void settle(uint8_t ended);
  ROIO_MCP2515_OUT_OF_LINE void finish_abort();
  bool may_end_otherwise();
  ROIO_MCP2515_OUT_OF_LINE void end_somehow(uint8_t buffer);
  TxOutcome outcome_of(uint8_t buffer);
  void end(uint8_t ended, TxOutcome outcome);
  void report(uint8_t token, TxOutcome outcome);
  bool has_over_in_chip();
  ROIO_MCP2515_OUT_OF_LINE static void count(typename Traits::Count& counter) { ++counter; }

  // looking after the chip
  void tend(bool looked);
  void check_soon();
  void check_chip();
  bool diagnose(uint8_t errors);
  ROIO_MCP2515_OUT_OF_LINE void lose_chip();
  ROIO_MCP2515_OUT_OF_LINE void forget_chip();

  Parts parts_;
  Counters counters_;
  /// READ STATUS as it last was, less what was read since. TXnIF: the chip is at work, else 0.
  /// TXREQ: what the chip was asked to send. RXB1 alone: it has the older frame, whether RXB0 is
  /// full or not.
  uint8_t status_;
  uint8_t error_flags_;  // EFLG when last looked at
  uint8_t control_;      // what CANCTRL must be
  uint8_t calls_;        // since the chip was last checked, and more when that should be soon
};

}  // namespace roio

/// A member function of the driver, without its template arguments each time.
#define ROIO_MCP2515_MEMBER(Type)                                             \
  template <typename Port, uint8_t RxQueue, uint8_t TxQueue, typename Traits> \
  Type Mcp2515<Port, RxQueue, TxQueue, Traits>
/// And one that has one of its own. NOLINTBEGIN(bugprone-macro-parentheses): it is a declaration.
#define ROIO_MCP2515_MEMBER_OF(Argument, Type)                                \
  template <typename Port, uint8_t RxQueue, uint8_t TxQueue, typename Traits> \
  template <typename Argument>                                                \
  Type Mcp2515<Port, RxQueue, TxQueue, Traits>
// NOLINTEND(bugprone-macro-parentheses)

#include <roio/mcp2515_mode.hpp>
#include <roio/mcp2515_receive.hpp>
#include <roio/mcp2515_send.hpp>
#include <roio/mcp2515_start.hpp>
#include <roio/mcp2515_watch.hpp>

#endif
