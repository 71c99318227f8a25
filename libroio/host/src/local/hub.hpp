#ifndef ROIO_LOCAL_HUB_HPP
#define ROIO_LOCAL_HUB_HPP

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <roio/error.hpp>
#include <roio/parts/fd.hpp>
#include <thread>
#include <vector>

#include "local/hub_client.hpp"
#include "local/medium.hpp"
#include "local/memory.hpp"
#include "local/place.hpp"
#include "local/poller.hpp"
#include "local/readers.hpp"
#include "local/roster.hpp"

namespace roio::local {

/// The middle of a local bus: takes frames from its clients, arbitrates among them, and writes each
/// to the log, where all read it. Runs in a thread of the process that holds the seat.
///
/// Flow: without a bit rate, the bus waits for a reader that lags and still reads (at least max_lag
/// frames behind, and read some in the last patience); one that does not read costs the others no
/// more than one patience. With a bit rate nobody is waited for. What the log runs over before it
/// was read is dropped and counted.
class Hub {
 public:
  /// Goes on with the bus that the seat's memory holds, or begins a new one where nobody is left of
  /// that, and starts serving.
  /// @param bitrate_bps of a new one; none: no limit.
  /// @param host the client of this process that is there to carry it; 0: it does so by chance.
  /// @throws std::system_error: no memory, thread or descriptor to be had.
  Hub(HubSeat seat, std::optional<std::uint32_t> bitrate_bps, std::uint64_t host);
  Hub(const Hub&) = delete;
  Hub& operator=(const Hub&) = delete;
  /// Leaves the seat. Frames that have not been carried are still with their senders, who offer
  /// them to the next hub.
  ~Hub();

  /// It has left the seat because it lacked memory or descriptors. For any thread.
  [[nodiscard]] bool has_failed() const noexcept { return failed_; }

 private:
  using Clock = std::chrono::steady_clock;

  // The thread.
  void run();
  void serve();
  void wait();
  [[nodiscard]] std::chrono::nanoseconds time_to_wait() const;
  void look_after_everybody();
  void leave() noexcept;

  // Clients.
  [[nodiscard]] bool may_accept() const;
  void accept_clients();
  void read(HubClient& client);
  void handle(HubClient& client, const Record& record);
  void greet(HubClient& client, const Hello& hello);
  [[nodiscard]] std::optional<Errc> objection_to(const Hello& hello) const;
  void refuse(HubClient& client, Errc why);
  /// @param fresh it has not had that slot before.
  void let_in(HubClient& client, std::uint64_t number, std::size_t slot, bool fresh);
  void take_frame(HubClient& client, const OfferedFrame& offered);
  void cut(HubClient& client) noexcept;
  void let_go(HubClient& client);
  void drop_closed_clients();

  // Slots.
  std::optional<std::size_t> give_slot(std::uint64_t client);
  void free_slots_of_the_dead();

  // Frames.
  void transmit();
  void carry(const Medium::Transmission& transmission, std::size_t listeners);
  [[nodiscard]] std::uint32_t window() const;

  HubSeat seat_;
  HubMemory memory_;
  Readers readers_;
  Roster roster_;
  std::optional<Medium> medium_;
  EventFlag stop_;
  Poller poller_;
  std::vector<std::unique_ptr<HubClient>> clients_;
  std::vector<std::size_t> done_;  // slots whose frames have been carried in this round
  Clock::time_point now_;
  Clock::time_point accept_again_{};
  Clock::time_point look_again_{};
  std::int64_t wall_offset_ns_ = 0;  // wall clock minus steady clock, looked at once a round
  bool accepting_ = true;            // the poller tells of new clients
  bool holding_ = false;             // for readers who lag
  bool is_over_ = false;  // another is to be the hub, or its files are not there any more
  std::atomic<bool> failed_{false};
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace roio::local

#endif
