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
/// counted. With an interrupt line a call
/// costs no SPI while nothing has happened. Not from an interrupt and the main program both.
///
/// **Cost.** For a frame with 8 bytes, in SPI bytes and transactions: received in a run or with an
/// interrupt line 16 in 2, the first one found by polling 18 in 3; sent 15 in 2, and 17 in 2 where
/// frames follow one another so closely that the chip must be told their order. A frame with n
/// bytes fewer costs n fewer. A call that finds nothing costs 2 in 1, or none with an interrupt
/// line. No call waits for the bus.
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
#include <roio/mcp2515_queue.hpp>
#include <roio/mcp2515_registers.hpp>
#include <roio/status.hpp>

namespace roio {

// What a Port has to look like. The driver constructs one from the arguments of its own
// constructor.
//
//   struct PortExample {
//     static constexpr bool has_interrupt_line = true;
//     bool interrupt_line_is_low();
//     uint32_t microseconds();        // free running, wraps at 2^32; only differences are used
//     class Transaction {             // chip select is low as long as one lives
//      public:
//       explicit Transaction(PortExample&);
//       uint8_t exchange(uint8_t out);
//       void restart();               // chip select high, then low again
//       ~Transaction();
//     };
//     class Uninterrupted {           // while one lives, nothing else runs: interrupts are off
//      public:
//       explicit Uninterrupted(PortExample&);
//       ~Uninterrupted();
//     };
//   };
//
// SPI mode 0,0 at 10 MHz at most (mode 1,1 would send a frame twice, errata item 5).

struct Mcp2515Config {
  BitTiming timing;
  Mcp2515Filters filters;
  mcp2515::Mode mode = mcp2515::Mode::normal;  ///< normal, listen_only or loopback.
  /// Each frame is tried once, then reported as failed.
  bool one_shot = false;
  /// How long begin() waits for the chip to answer: a crystal takes up to some milliseconds.
  uint16_t start_timeout_ms = 20;

  // Written out because C++11 takes no aggregate with defaults.
  Mcp2515Config(const BitTiming& t, const Mcp2515Filters& f) : timing(t), filters(f) {}
};

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
  Count foreign;         ///< Standard and remote frames, dropped.
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
};

/// What to leave in. Derive from it, change what differs, pass it as Traits.
struct Mcp2515Traits {
  using Count = uint16_t;
  /// Standard and remote frames can be sent, and are handed out when the chip lets them through.
  static constexpr bool all_kinds = false;
  /// Only transmit buffer 0 is used: for chips before revision B2, which may spoil the others when
  /// told to send while they receive (errata item 2). An urgent frame then waits for the one that
  /// the chip has.
  static constexpr bool only_buffer_0 = false;
  /// Whether anybody wants to know what became of each frame. If not, the driver does not ask the
  /// chip just for that.
  static constexpr bool reports_outcomes = false;
  /// Called from send(), poll(), receive(), abort(), begin() and check_clock(), with the token that
  /// send() was given. Must not call the driver.
  void on_outcome(uint8_t, TxOutcome) {}
};

/// @tparam RxQueue frames that poll() fetches ahead of receive(), 0..127, 14 bytes each. 0: each
///         receive() reads one from the chip.
/// @tparam TxQueue frames that wait beside those in the chip (two normal ones and an urgent one),
///         0..127, 15 bytes each. 0: send() says full when the chip has no room.
template <typename Port, uint8_t RxQueue = 2, uint8_t TxQueue = 2, typename Traits = Mcp2515Traits>
class Mcp2515 {
 public:
  using Counters = Mcp2515Counters<typename Traits::Count>;

  template <typename... Arguments>
  explicit Mcp2515(Arguments&&... arguments)
      : port_(static_cast<Arguments&&>(arguments)...),
        traits_(),
        counters_(),
        quick_(0),
        error_flags_(0),
        control_(0),
        calls_(0),
        running_(false),
        fresh_(false),
        check_due_(false),
        rx1_is_older_(false),
        aborting_(false),
        pending_(0),
        level_(0),
        priority_(),
        token_() {}

  Mcp2515(const Mcp2515&) = delete;
  Mcp2515& operator=(const Mcp2515&) = delete;
  ~Mcp2515() = default;

  /// Resets the chip and sets it up; what it held is gone (frames that it was to send are reported
  /// as unknown). What waits in the queues stays. May be called again at any time, and must be when
  /// poll() says that the chip is lost. Takes 1 ms when all is well; at most
  /// config.start_timeout_ms for a chip that does not answer, and 50 ms for a bus that is never
  /// idle for 11 bits.
  /// @return ok. bad_timing: the chip cannot run at this timing; bad_argument: filters that cannot
  ///         keep the order (Mcp2515Filters::in_order), or configuration mode; after these two
  ///         nothing was touched.
  ///         no_chip: no answer, or not what was written. wrong_mode: the mode was not entered (the
  ///         bus is stuck, or has no transceiver).
  ROIO_NODISCARD Status begin(const Mcp2515Config& config);

  /// Fetches what has come in (with RxQueue 0 that is receive()'s alone), hands over what waits,
  /// looks after errors. Bounded: at most RxQueue + 2 frames and a handful of registers.
  /// @return ok; no_chip: the chip was reset or is not there, or begin() has not succeeded yet.
  Status poll();

  /// The oldest frame received. With a queue, looks at the chip only when the queue is empty.
  /// @param frame a frame on ok only.
  /// @return ok; empty; no_chip as for poll().
  ROIO_NODISCARD Status receive(Frame& frame);

  /// Queues a frame. Urgent ones (bit 28 of the identifier is 0) leave before normal ones, first in
  /// first out within each. Up to two normal frames are in the chip already and may go between two
  /// urgent ones.
  /// @param frame copied.
  /// @param token comes back with the frame's outcome.
  /// @return ok: it will be sent, and reported; full: nothing was stored, try again after poll();
  ///         bad_argument: an identifier, length or kind that may not be sent; wrong_mode: listen
  ///         only; no_chip: begin() has not succeeded, or the chip is lost.
  ROIO_NODISCARD Status send(const Frame& frame, uint8_t token = 0);

  /// Takes back all frames that are not yet on the wire. Each is reported, as aborted or, if it was
  /// too late, as sent; poll() until in_flight() is 0. Meanwhile send() says full.
  void abort();

  /// How many frames are in the chip to be sent, as far as was last seen.
  uint8_t in_flight() const {
    return static_cast<uint8_t>(((pending_ >> 2) & 1U) + ((pending_ >> 4) & 1U) + (pending_ >> 6));
  }
  /// How many received frames receive() has without looking at the chip.
  uint8_t fetched() const { return rx_queue_.size(); }
  /// How many wait for the chip.
  uint8_t waiting() const { return tx_queue_.size(); }

  /// Reads the chip's error counters.
  void read_error_counters(uint8_t& transmit, uint8_t& receive);

  /// Finds out whether the oscillator is what `config.timing` takes it for, by sending a frame from
  /// the chip to itself and timing it. Nothing goes to the bus. Ends in configuration mode: begin()
  /// comes after it. Takes three frames of 131 bits and two resets; twelve times as long as these
  /// should take, and 120 ms, at most.
  /// @param osc_hz what the timing was computed for, 1,000,000 or more.
  /// @param measured_hz what the oscillator is, to some percent; 0 when it is slower than one
  /// twelfth,
  ///        and unless ok or wrong_clock.
  /// @return ok: within one eighth; wrong_clock; bad_argument: osc_hz too low; else as begin().
  ROIO_NODISCARD Status check_clock(const Mcp2515Config& config, uint32_t osc_hz,
                                    uint32_t& measured_hz);

  bool running() const { return running_; }
  Mcp2515State state() const;
  const Counters& counters() const { return counters_; }
  Port& port() { return port_; }
  Traits& traits() { return traits_; }

 private:
  using Instruction = mcp2515::Instruction;
  using Register = mcp2515::Register;
  using QuickStatus = mcp2515::QuickStatus;
  using Transaction = typename Port::Transaction;

  struct Waiting {
    Frame frame;
    uint8_t token;
  };

  // Transmit buffers: 0 is for urgent frames, 2 and 1 for normal ones in turn.
  static constexpr uint8_t urgent_slot = 0;
  static constexpr uint8_t urgent_level = 3;
  static constexpr uint8_t highest_normal_level = 2;

  /// Bit 28, in the byte where an AVR finds it at once.
  static bool is_urgent(const Frame& frame) {
    return (!Traits::all_kinds || is_extended(frame.kind)) &&
           (static_cast<uint8_t>(frame.id >> 24) & 0x10U) == 0;
  }
  bool is_sendable(const Frame& frame) const {
    return is_valid(frame) && frame.kind != FrameKind::error &&
           (Traits::all_kinds || frame.kind == FrameKind::extended);
  }

  // single accesses
  uint8_t read_register(Register address);
  void read_registers(Register address, uint8_t* values, uint8_t count);
  void write_registers(Register address, const uint8_t* values, uint8_t count);
  void modify_register(Register address, uint8_t mask, uint8_t value);
  bool write_and_compare(Register address, const uint8_t* values, uint8_t count);
  uint8_t read_quick_status();

  // starting
  void pause(uint16_t microseconds);
  bool reset_chip(uint16_t timeout_ms);
  bool configure(const Mcp2515Config& config);
  void count_what_begin_forgets();
  bool enter_mode(uint8_t control);
  void load_clock_frames();
  uint32_t time_clock_frames(uint32_t limit_us);

  // what READ STATUS shows
  bool is_plausible(uint8_t quick) const;
  void note(uint8_t quick, bool freed_rx0 = false);

  // receiving
  bool find_received();
  bool fetch(Frame& frame);
  bool read_rx_buffer(uint8_t buffer, Frame& frame);
  static void read_frame(Transaction& transaction, uint8_t buffer, Frame& frame);

  // sending
  bool give_to_chip(const Frame& frame, uint8_t token);
  Status enqueue(const Frame& frame, uint8_t token);
  void pump();
  uint8_t choose_slot(bool urgent, uint8_t& level) const;
  bool load(const Frame& frame, uint8_t token);
  void settle(uint8_t quick);
  TxOutcome outcome_of(uint8_t slot);
  void report(uint8_t token, TxOutcome outcome);

  // looking after the chip
  void tend();
  void check_chip();
  void lose_chip();
  void forget_chip();

  Port port_;
  Traits traits_;
  Counters counters_;
  uint8_t quick_;        // receive flags that READ STATUS last showed, less what was read since
  uint8_t error_flags_;  // EFLG when last looked at
  uint8_t control_;      // what CANCTRL must be
  uint8_t calls_;        // since the chip was last checked
  bool running_;
  bool fresh_;         // READ STATUS was read in this call
  bool check_due_;     // frames may have been lost
  bool rx1_is_older_;  // of two full receive buffers
  bool aborting_;
  uint8_t pending_;      // what the chip was asked to send, bit for bit TXREQ in READ STATUS
  uint8_t level_;        // TXP of the normal frame given to the chip last
  uint8_t priority_[3];  // TXP as written
  uint8_t token_[3];
  mcp2515::Ring<Frame, RxQueue> rx_queue_;
  mcp2515::Ring<Waiting, TxQueue> tx_queue_;
};

}  // namespace roio

#include <roio/mcp2515_impl.hpp>

#endif
