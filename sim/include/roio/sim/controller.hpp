/// Controller: the CAN protocol as a node on the bus lives it, bit by bit: arbitration, stuffing,
/// acknowledgement, error flags and fault confinement. Knows neither registers nor queues; whoever
/// owns it (the MCP2515 model, a host node) is its ControllerClient.
/// Source: Bosch CAN specification 2.0 part B; ISO 11898-1.
#ifndef ROIO_SIM_CONTROLLER_HPP
#define ROIO_SIM_CONTROLLER_HPP

#include <cstdint>
#include <memory>
#include <optional>
#include <roio/frame.hpp>
#include <roio/sim/time.hpp>

namespace roio::sim {

constexpr std::uint8_t dominant = 0;
constexpr std::uint8_t recessive = 1;

/// What a controller found wrong on the bus (CAN 2.0B, 6.1 "Error detection").
enum class BusError : std::uint8_t { bit, stuff, crc, form, acknowledge };
const char* to_string(BusError error);

/// Fault confinement (CAN 2.0B, 7).
enum class Confinement : std::uint8_t { active, passive, bus_off };

/// A frame that asks for the bus.
struct Submission {
  Frame frame;    ///< A length of 9..15 is a DLC that carries 8 bytes.
  SimTime since;  ///< When it was asked for; latency counts from here.
};

/// What a controller asks of its owner and tells it. All calls come while a bit begins or is
/// sampled: the owner may switch the mode, join and leave the bus, and request, but not run it.
class ControllerClient {
 public:
  ControllerClient() = default;
  ControllerClient(const ControllerClient&) = delete;
  ControllerClient& operator=(const ControllerClient&) = delete;
  virtual ~ControllerClient() = default;

  /// The bus is free: what to send, if anything. Asked anew for every attempt.
  virtual std::optional<Submission> next_submission() = 0;
  /// The frame of the last next_submission() was sent and acknowledged.
  virtual void on_transmitted() = 0;
  /// Another node's frame won; the frame may be submitted again.
  virtual void on_arbitration_lost() = 0;
  /// The attempt ended in an error; the frame may be submitted again.
  virtual void on_transmit_error(BusError error) = 0;
  /// A frame of another node came in whole. Its length is the DLC as it was, 0..15.
  virtual void on_received(const Frame& frame) = 0;
  /// An error in another node's frame, or outside of any (in a flag or a delimiter).
  virtual void on_receive_error(BusError error) = 0;
  /// An error counter or the state it makes has changed.
  virtual void on_confinement_changed() = 0;
  /// It has seen the 11 recessive bits that it waited for, since set_mode() or, when it only
  /// listens, since an error; it takes part now.
  virtual void on_integrated() {}
  /// The wire became dominant while the controller was asleep.
  virtual void on_bus_activity() {}
};

class Controller {
 public:
  enum class Mode : std::uint8_t {
    off,          ///< Takes no part, drives nothing.
    asleep,       ///< Takes no part, but tells of a dominant bit.
    normal,       ///< Sends, receives, acknowledges.
    listen_only,  ///< Receives and drives nothing; the error counters stand still.
  };

  /// Who watches all controllers of a bus.
  class Monitor {
   public:
    Monitor() = default;
    Monitor(const Monitor&) = delete;
    Monitor& operator=(const Monitor&) = delete;
    virtual ~Monitor() = default;
    virtual void on_transmitted(const Controller& sender) = 0;
    virtual void on_transmit_error(const Controller& sender) = 0;
    virtual void on_arbitration_lost(const Controller& sender) = 0;
  };

  /// @param client must outlive the controller.
  explicit Controller(ControllerClient& client);
  ~Controller();
  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;

  /// Leaving off, a node waits for 11 recessive bits before it takes part.
  void set_mode(Mode mode);
  [[nodiscard]] Mode mode() const { return mode_; }

  /// @param monitor null: nobody.
  void set_monitor(Monitor* monitor) { monitor_ = monitor; }

  /// A fault: the transmitter is cut off from the wire, which the node still hears.
  void cut_transmitter(bool cut) { cut_ = cut; }

  /// Tells that next_submission() may have something.
  void request() { requested_ = true; }

  /// Sets both error counters to 0 and the state to error-active, as a reset does.
  void reset_error_counters();

  [[nodiscard]] unsigned transmit_errors() const { return transmit_errors_; }
  [[nodiscard]] unsigned receive_errors() const { return receive_errors_; }
  [[nodiscard]] Confinement confinement() const;

  /// Whether a frame of its own is on the wire and has not lost arbitration.
  [[nodiscard]] bool transmitting() const { return transmitting_; }
  /// Whether it is neither off, nor idle, nor waiting to become so.
  [[nodiscard]] bool busy() const { return state_ >= State::frame; }
  /// Whether nothing happens to it as long as the bus is recessive and nobody requests anything.
  [[nodiscard]] bool quiet() const {
    return state_ <= State::asleep ||
           (state_ == State::idle && !(requested_ && mode_ == Mode::normal));
  }
  /// The frame of its last attempt.
  [[nodiscard]] const Submission& submission() const { return submission_; }

  /// The bus's side, once a bit each: begin_bit() returns the level that this node drives, sample()
  /// takes the level that the wire has.
  std::uint8_t begin_bit() {
    if (state_ == State::idle && requested_) {
      try_to_start();
    }
    return cut_ ? recessive : output_;
  }
  void sample(std::uint8_t level) {
    if (state_ == State::frame) {
      sample_frame(level);
    } else {
      sample_outside_frame(level);
    }
  }

 private:
  // In this order: busy() counts on it.
  enum class State : std::uint8_t {
    off,
    asleep,
    integrating,  // waiting for 11 recessive bits
    bus_off,      // waiting for 128 times 11 recessive bits
    suspended,    // error-passive, just sent: 8 bits longer than others
    idle,
    frame,          // start-of-frame to end of CRC
    tail,           // CRC delimiter to end of frame
    error_flag,     // 6 dominant bits, or 6 equal ones when error-passive
    overload_flag,  // 6 dominant bits
    flag_end,       // until the wire is recessive again
    delimiter,      // the rest of 8 recessive bits
    intermission,   // 3 bits
  };
  struct Parts;

  void enter(State state, std::uint8_t output);
  void try_to_start();
  void start_frame(std::uint8_t level);
  void sample_frame(std::uint8_t level);
  void sample_outside_frame(std::uint8_t level);
  bool sample_own_bit(std::uint8_t level);
  void end_of_crc();
  void sample_tail(std::uint8_t level);
  void sample_acknowledge_slot(std::uint8_t level);
  void sample_end_of_frame(std::uint8_t level);
  void sample_flag(std::uint8_t level);
  void sample_flag_end(std::uint8_t level);
  void sample_delimiter(std::uint8_t level);
  void sample_intermission(std::uint8_t level);
  void sample_suspended(std::uint8_t level);
  void sample_bus_off(std::uint8_t level);
  void set_next_output();
  void lose_arbitration();
  void transmitted();
  void fail(BusError error);
  void fail(BusError error, unsigned amount);
  void acknowledged();
  void overload();
  void count_error(unsigned amount);
  void confine();

  ControllerClient& client_;
  Monitor* monitor_ = nullptr;
  std::unique_ptr<Parts> parts_;  // the frame under way: its parser and, when sending, its bits
  State state_ = State::off;
  Mode mode_ = Mode::off;
  Confinement confinement_ = Confinement::active;
  std::uint8_t output_ = recessive;
  bool cut_ = false;
  bool requested_ = false;
  bool transmitting_ = false;
  bool was_transmitter_ = false;         // of the frame before, for suspend and for error counters
  bool passive_flag_ = false;            // the error flag under way is recessive
  bool after_error_flag_ = false;        // the flag before was one of error, not of overload
  bool owed_acknowledge_error_ = false;  // counted only if a dominant bit shows up in the flag
  bool crc_matches_ = false;
  std::uint8_t count_ = 0;        // bits of the present state
  std::uint8_t equal_level_ = 0;  // of the run that completes a passive flag
  std::uint8_t sequences_ = 0;    // of 11 recessive bits while bus-off
  unsigned transmit_errors_ = 0;
  unsigned receive_errors_ = 0;
  Submission submission_{};
};

}  // namespace roio::sim

#endif
