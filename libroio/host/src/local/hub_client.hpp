#ifndef ROIO_LOCAL_HUB_CLIENT_HPP
#define ROIO_LOCAL_HUB_CLIENT_HPP

#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <roio/parts/fd.hpp>
#include <span>
#include <vector>

#include "local/counters.hpp"
#include "local/medium.hpp"
#include "local/protocol.hpp"
#include "local/stream.hpp"

namespace roio::local {

inline constexpr std::uint64_t queue_limit = 65536;  ///< Frames due to a client and not consumed.
inline constexpr std::uint64_t max_lag = 16384;      ///< Behind which the bus waits for a reader.
/// How long the bus waits for a reader that has stopped reading.
inline constexpr std::chrono::milliseconds patience{100};

/// The hub's side of one client: its connection, filters, and the frames due to it.
class HubClient {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  HubClient(UniqueFd socket, TimePoint now) : stream_(std::move(socket)), since_(now) {}

  [[nodiscard]] Stream& stream() { return stream_; }
  [[nodiscard]] const Stream& stream() const { return stream_; }
  [[nodiscard]] const std::shared_ptr<Station>& station() const { return station_; }
  [[nodiscard]] bool greeted() const { return station_ != nullptr; }
  [[nodiscard]] bool greeting_overdue(TimePoint now) const;

  /// Lets the client in. @param listeners see note_listeners(). @throws std::system_error when
  /// there is no memory to share.
  void welcome(std::shared_ptr<Station> station, bool rejoining, const Welcome& welcome,
               std::uint64_t listeners);
  void refuse(const Refused& refused) { append_record(stream_.out(), refused); }
  void set_filters(std::vector<SocketCanFilter> filters) { filters_ = std::move(filters); }
  /// Whether any frame at all may be due to it.
  [[nodiscard]] bool listens() const { return stream_.open() && !filters_.empty(); }
  /// Publishes how many listen, itself left out.
  void note_listeners(std::uint64_t count);
  /// One of its frames has been carried and nobody was there to have it; all these have been had.
  void note_unheard();
  void forget_unheard();
  /// True once, after a client has come over from another hub: it is owed what that one missed.
  [[nodiscard]] bool take_replay_due() { return std::exchange(replay_due_, false); }
  /// @return false: more than was ever delivered.
  bool consumed(std::uint64_t count, TimePoint now);

  [[nodiscard]] bool wants(std::uint32_t tagged) const;
  /// Counts frames due to the client that nobody has any more.
  void drop(std::uint64_t count);
  /// Queues a frame, or drops and counts it when the queue is full.
  void deliver(Deliver deliver, std::uint64_t bus_number, TimePoint now);
  void report_done(std::size_t lane, std::uint64_t sequence);
  /// Queues one done record for all of report_done() since the last time.
  void append_done();

  /// Sends what the socket takes. @return false: the connection is gone.
  bool flush(TimePoint now);

  /// Whether the bus should wait: this reader lags, and has read lately.
  [[nodiscard]] bool holds_bus(TimePoint now) const;
  /// The number of the first frame that is still here and not in the socket; none: all are.
  [[nodiscard]] std::optional<std::uint64_t> first_unflushed() const;
  /// Whether senders should wait for those: the socket took something lately.
  [[nodiscard]] bool holds_done(TimePoint now, bool paced) const;
  /// Publishes how many of the frames still here have been reported done up to that number.
  void note_risk(std::uint64_t done_number);

 private:
  /// A frame that is still in stream_.out(): where it ends there, and which it is.
  struct Unflushed {
    std::uint64_t end;
    std::uint64_t bus_number;
  };

  Stream stream_;
  std::shared_ptr<Station> station_;
  std::vector<SocketCanFilter> filters_;
  std::unique_ptr<CounterPage> page_;
  TimePoint since_;        // of the connection
  std::uint64_t due_ = 0;  // frames delivered or dropped
  std::uint64_t delivered_ = 0;
  std::uint64_t consumed_ = 0;
  std::uint64_t checkpoint_ = 0;  // of consumed_, when the reader last showed that it reads
  TimePoint checkpoint_time_{};
  std::deque<Unflushed> unflushed_;
  std::uint64_t flushed_ = 0;  // frames that the socket took
  std::uint64_t flush_checkpoint_ =
      0;  // of flushed_, when the socket last showed that it takes them
  TimePoint flush_time_{};
  std::array<std::uint64_t, lane_count> done_{};
  bool done_changed_ = false;
  std::uint64_t done_end_ = 0;  // where in the stream the last done record ends
  bool replay_due_ = false;
};

}  // namespace roio::local

#endif
