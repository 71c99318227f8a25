#ifndef ROIO_SIM_NETWORK_EXCHANGE_HPP
#define ROIO_SIM_NETWORK_EXCHANGE_HPP

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <roio/bus.hpp>
#include <roio/parts/bus_events.hpp>
#include <roio/parts/deadline.hpp>
#include <roio/parts/fd.hpp>
#include <roio/parts/lanes.hpp>
#include <roio/parts/receive_queue.hpp>
#include <roio/sim/time.hpp>
#include <span>
#include <vector>

namespace roio::sim {

/// Where a participant's program and the simulation's thread meet: frames on their way in both
/// directions, and what is known of the controller. Each call is safe beside any other.
class Exchange {
 public:
  static constexpr std::size_t lane_capacity = 128;
  static constexpr std::size_t receive_capacity = 4096;

  explicit Exchange(const OpenOptions& options);

  // --- the program's side ------------------------------------------------------------------------

  struct Offered {
    std::size_t count;  ///< The first so many were accepted.
    bool wake;          ///< The simulation did not know yet that frames wait.
  };
  /// Accepts frames as long as their lanes have room and it is their turn, up to the first of which
  /// that is not so. If not all were, events().room() is set once it is.
  /// @param since when in simulated time this is: the simulation may be a bit behind and must not
  ///        send them earlier.
  Offered offer(std::span<const Frame> frames, SimTime since);
  void count_send_wait();
  void count_send_timeout();
  std::size_t take(std::span<Received> frames);
  void set_filters(std::span<const SocketCanFilter> filters);
  /// Set while frames wait to be taken.
  [[nodiscard]] const EventFlag& readable() const { return queue_.readable(); }
  [[nodiscard]] BusEvents& events() { return events_; }
  [[nodiscard]] BusState state() const;
  [[nodiscard]] Statistics statistics() const;
  /// Accepts and delivers nothing from now on. @param until what was accepted may be sent.
  void begin_close(const Deadline& until);
  /// Waits until the simulation has no more to do with it.
  void await_left();

  // --- the simulation's side ---------------------------------------------------------------------

  [[nodiscard]] bool has_work() const;
  /// The lane's first frame, if it has one at that time. It stays until it is handed over.
  [[nodiscard]] std::optional<Frame> next(std::size_t lane, SimTime now) const;
  void handed_over(std::size_t lane);
  /// What became of a frame that was handed over.
  void settled(bool sent);
  void deliver(const Frame& frame, Timestamp time);

  /// What is new with the controller.
  struct News {
    BusState state;
    Frame report;  ///< FrameKind::error.
    std::uint64_t overruns;
    std::uint64_t bus_offs;
  };
  void tell(const News& news, Timestamp time);
  void count_outage();
  /// Gives up what still waits to be handed over.
  void abandon();
  /// Whether the station is to go: closed, and what was accepted has been sent, or the time is up.
  [[nodiscard]] bool wants_to_leave() const;
  /// The station has gone.
  void left();
  /// There is no simulation any more.
  void end();

 private:
  struct Waiting {
    Frame frame;
    SimTime since;
  };

  // The caller holds mutex_ for these.
  [[nodiscard]] bool all_settled() const;
  void abandon_locked();
  void wake_sender();
  void enqueue(const Frame& frame, Timestamp time);
  void look_for_events();
  void left_locked();

  BusEvents events_;
  const bool error_frames_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;  // left_
  std::array<std::deque<Waiting>, lane_count> lanes_;
  std::size_t in_chip_ = 0;
  LaneOrder order_;
  bool sender_waits_ = false;
  std::optional<Deadline> closed_;  // what was accepted may be sent until then
  bool left_ = false;
  std::vector<SocketCanFilter> filters_;
  ReceiveQueue queue_{receive_capacity};
  BusState state_ = BusState::active;
  Statistics statistics_;
};

}  // namespace roio::sim

#endif
