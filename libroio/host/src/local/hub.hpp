#ifndef ROIO_LOCAL_HUB_HPP
#define ROIO_LOCAL_HUB_HPP

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <roio/parts/fd.hpp>
#include <thread>
#include <vector>

#include "local/hub_client.hpp"
#include "local/medium.hpp"
#include "local/place.hpp"

namespace roio::local {

/// The middle of a local bus: takes frames from its clients, arbitrates among them, hands each to
/// all the others that want it. Runs in a thread of the process that holds the seat.
///
/// Flow: without a bit rate, the bus waits for a reader that lags and still reads (at least max_lag
/// frames behind, and consumed some in the last patience); one that does not read costs the others
/// no more than one patience. With a bit rate nobody is waited for. A reader's queue holds
/// queue_limit frames; what is due beyond is dropped and counted.
class Hub {
 public:
  /// Starts serving. @throws std::system_error: no thread or descriptor to be had.
  Hub(HubSeat seat, std::optional<std::uint32_t> bitrate_bps);
  Hub(const Hub&) = delete;
  Hub& operator=(const Hub&) = delete;
  /// Passes on what has been arbitrated already (within a moment), then leaves the seat. Frames
  /// that have not been are still with their senders, who offer them to the next hub.
  ~Hub();

 private:
  using Clock = std::chrono::steady_clock;

  /// A frame on its way out, until every reader that is waited for has it in its socket.
  struct Leaving {
    std::uint64_t number;  // in the order of the bus, from 1
    std::shared_ptr<Station> from;
    std::size_t lane;
    std::uint64_t sequence;
  };

  void run();
  void wait();
  void accept_clients();
  void read_clients();
  void handle(HubClient& client, const Record& record);
  void greet(HubClient& client, const Hello& hello);
  void take_frame(HubClient& client, const OfferedFrame& offered);
  [[nodiscard]] std::uint64_t listeners() const;
  void note_listeners();
  void transmit();
  void replay(HubClient& client);
  void fan_out(const Medium::Transmission& transmission);
  void flush_clients();
  void report_done();
  void drop_closed_clients();
  void finish();
  [[nodiscard]] bool may_accept() const;
  [[nodiscard]] bool must_hold() const;
  [[nodiscard]] std::chrono::nanoseconds time_to_wait() const;
  [[nodiscard]] std::uint32_t window() const;

  HubSeat seat_;
  Medium medium_;
  EventFlag stop_;
  std::vector<std::unique_ptr<HubClient>> clients_;
  std::deque<Leaving> leaving_;
  std::deque<Deliver> history_;    // the frames carried last
  std::uint64_t bus_number_ = 0;   // of the frame fanned out last
  std::uint64_t done_number_ = 0;  // of the frame last reported done
  Clock::time_point now_;
  Clock::time_point accept_again_{};
  std::int64_t wall_offset_ns_ = 0;  // wall clock minus steady clock, looked at once a round
  std::thread thread_;               // last: it uses all of the above
};

}  // namespace roio::local

#endif
