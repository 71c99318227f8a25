/// CanBus: the wire between controllers, and the simulation's clock. Every bit of every frame is on
/// it: the wire is dominant where any node drives it so, and what follows from that (arbitration,
/// acknowledgement, errors) is left to the controllers.
///
///   sim::CanBus bus;
///   sim::HostNode pc(bus, 500'000);
///   sim::Mcp2515Chip chip(bus, {.osc_hz = 16'000'000});
///   bus.run_for(std::chrono::milliseconds(1));
///
/// Nodes of one bit rate (to a thousandth) keep step exactly. A node of another rate samples the
/// wire at its own times, synchronises on falling edges as far as its jump width goes, and disturbs
/// or is disturbed accordingly. Not modelled: propagation delay, and oscillators that drift. Not
/// for several threads at once. Source: docs/internals/simulator.md.
#ifndef ROIO_SIM_CAN_BUS_HPP
#define ROIO_SIM_CAN_BUS_HPP

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <roio/frame.hpp>
#include <roio/sim/controller.hpp>
#include <roio/sim/time.hpp>
#include <vector>

namespace roio::sim {

/// What the bus adds up. Latency is from submission to the last bit of the frame, of extended
/// frames by Roio's priority bit; standard frames count as normal.
struct BusStatistics {
  struct Latency {
    std::uint64_t frames = 0;
    SimTime sum{0};
    SimTime max{0};
    [[nodiscard]] SimTime mean() const;
  };
  std::uint64_t frames = 0;           ///< Sent and acknowledged; one for each sender.
  std::uint64_t transmit_errors = 0;  ///< Attempts that ended in an error.
  std::uint64_t arbitrations_lost = 0;
  std::uint64_t flipped_bits = 0;  ///< By set_bit_errors() and flip_next_bit().
  SimTime busy{0};  ///< Start-of-frame to the end of the intermission; error frames, too.
  SimTime time{0};  ///< Since the simulation began.
  /// The part of the time that the bus was busy, 0..1.
  [[nodiscard]] double load() const;
  Latency urgent;
  Latency normal;
};

/// When a node samples, and how far it shifts to stay in step.
struct NodeTiming {
  SimTime bit;           ///< Above 0.
  SimTime sample_point;  ///< From the beginning of the bit; 0 < sample_point < bit.
  SimTime jump_width;
};
/// A node with the default sample point (80 %) and one eighth of a bit to jump.
NodeTiming timing_of(std::uint32_t bitrate_bps);

class CanBus : private Controller::Monitor {
 public:
  CanBus() = default;
  CanBus(const CanBus&) = delete;
  CanBus& operator=(const CanBus&) = delete;
  ~CanBus() override;

  [[nodiscard]] SimTime now() const { return now_; }
  /// What is to happen at `time` itself: actions do, bits are left for the next run.
  /// @throws std::logic_error when called from within a bit, that is, by a ControllerClient.
  void run_until(SimTime time);
  void run_for(SimTime span) { run_until(now_ + span); }

  /// Calls `action` at a time from now on, before the bits that begin or are sampled then; same
  /// times in the order asked for. A time gone by counts as now. An action may run the bus in its
  /// turn.
  void at(SimTime time, std::function<void()> action);
  void after(SimTime span, std::function<void()> action) { at(now_ + span, std::move(action)); }
  /// Something that is simulated beside the bus and keeps in step with it, such as a processor.
  class Companion {
   public:
    Companion() = default;
    Companion(const Companion&) = delete;
    Companion& operator=(const Companion&) = delete;
    virtual ~Companion() = default;
    /// Called when its time comes, after the actions of that time and before the bits. It sets its
    /// next time, and must not run the bus.
    virtual void step() = 0;

    /// When to be called next; none: not at all.
    std::optional<SimTime> next;
    /// How long after such a call, at the earliest, other companions may feel anything of it as
    /// long as the bus is idle.
    SimTime reach{0};
  };
  /// Companions of one time are called in the order in which they were attached. One must be
  /// detached before it ends.
  void attach(Companion& companion) { companions_.push_back(&companion); }
  void detach(Companion& companion) { std::erase(companions_, &companion); }
  /// Until then nothing happens that this companion could feel, but what it does itself: the next
  /// action, the reach of another companion, the next bit that begins or is sampled, the end of the
  /// run. So far it may run ahead. Outside of a run: now.
  [[nodiscard]] SimTime quiet_until(const Companion& companion) const;

  /// A controller may join and leave at any time; it must leave before it ends. Joining again
  /// changes its timing.
  void join(Controller& controller, const NodeTiming& timing);
  void leave(Controller& controller);

  // --- faults ------------------------------------------------------------------------------------

  /// From now on, each bit is flipped with this probability: every other time for all nodes of a
  /// rate alike, else as one node sees it. 0: no longer. An idle bus has no bits.
  void set_bit_errors(double probability, std::uint32_t seed);
  /// Holds the wire at dominant, as a short circuit or a broken transceiver does.
  void hold_dominant(bool hold) { held_ = hold; }
  /// Flips one bit, the next that is sampled, for all nodes of a rate (for one, when given).
  void flip_next_bit(Controller* victim = nullptr);

  // --- what happens ------------------------------------------------------------------------------

  /// Called with every frame sent and acknowledged, at its last bit.
  void on_frame(std::function<void(const Frame&, const Controller& sender)> observer);
  [[nodiscard]] BusStatistics statistics() const;

 private:
  // Controllers that keep step with one another.
  struct Domain {
    NodeTiming timing;
    std::vector<Controller*> members;  // null: left within the bit under way
    SimTime bit_start{0};
    bool sampling = false;  // the next event is the sample point, not the next bit
    std::uint8_t driven = recessive;

    [[nodiscard]] SimTime next() const {
      return sampling ? bit_start + timing.sample_point : bit_start + timing.bit;
    }
  };
  struct Joining {
    Controller* controller;
    NodeTiming timing;
  };
  struct Action {
    SimTime time;
    std::uint64_t order;
    std::function<void()> action;
  };
  static bool later(const Action& a, const Action& b);

  void run_to(SimTime time);
  void run_due();
  [[nodiscard]] std::optional<SimTime> next_call() const;
  [[nodiscard]] bool quiet() const;
  [[nodiscard]] bool is_idle(const Domain* next) const;
  [[nodiscard]] std::uint8_t wire() const;
  [[nodiscard]] Domain* next_domain() const;
  void skip_to(SimTime time);
  void step(Domain& domain);
  void begin_bit(Domain& domain);
  void sample(Domain& domain);
  void count_busy(const Domain& domain);
  void admit(Controller& controller, const NodeTiming& timing);
  void tidy();
  void sample_with_fault(Domain& domain, std::uint8_t level);
  std::optional<Controller*> draw_victim(const Domain& domain);
  void falling_edge(const Domain& source);
  void draw_next_fault();
  void run_actions();
  void on_transmitted(const Controller& sender) override;
  void on_transmit_error(const Controller& sender) override;
  void on_arbitration_lost(const Controller& sender) override;

  SimTime now_{0};
  SimTime run_end_{0};  // of the innermost run
  std::vector<std::unique_ptr<Domain>> domains_;
  std::vector<Action> actions_;  // a heap, the earliest first
  std::uint64_t actions_so_far_ = 0;
  std::vector<Companion*> companions_;
  bool within_bit_ = false;
  bool left_within_bit_ = false;
  std::vector<Joining> joining_;  // within the bit under way
  SimTime busy_until_{0};
  bool held_ = false;
  bool flip_next_ = false;
  Controller* flip_victim_ = nullptr;
  double fault_probability_ = 0;
  std::uint64_t samples_to_fault_ = 0;
  std::mt19937 generator_;
  std::vector<std::function<void(const Frame&, const Controller&)>> observers_;
  BusStatistics statistics_;
};

}  // namespace roio::sim

#endif
