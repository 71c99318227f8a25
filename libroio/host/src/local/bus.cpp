#include "local/bus.hpp"

#include <poll.h>

#include <algorithm>
#include <array>
#include <condition_variable>
#include <deque>
#include <limits>
#include <mutex>
#include <roio/error.hpp>
#include <roio/parts/frame_check.hpp>
#include <roio/parts/lanes.hpp>
#include <roio/parts/queued_calls.hpp>
#include <roio/parts/receive_queue.hpp>
#include <roio/parts/thread.hpp>
#include <thread>
#include <utility>
#include <vector>

#include "local/connection.hpp"
#include "local/senders.hpp"

namespace roio {
namespace local {
namespace {

constexpr std::chrono::seconds close_time{1};
// Consumed frames are reported in lots, for it is a system call here and one in the hub.
constexpr std::uint64_t consumed_lot = 512;
constexpr std::chrono::milliseconds retry_interval{200};
// A hub takes its clients' bytes within microseconds, unless it is stopped.
constexpr std::chrono::seconds filter_time{1};

/// The client of a local bus. A thread of its own reads, so that frames, and a hub to be replaced,
/// do not wait for the program to call.
class LocalBus final : public Bus {
 public:
  LocalBus(const std::string& bus_name, std::optional<std::uint32_t> bitrate_bps,
           const OpenOptions& options)
      : name_("local:" + bus_name),
        connector_(bus_name, bitrate_bps, !options.join_only),
        order_(options.in_order) {
    if (!options.send_only) {
      filters_ = {SocketCanFilter{0, 0}};
    }
    auto connection = connector_.connect(Deadline(options.open_timeout), stop_);
    if (!connection) {
      throw std::system_error(Errc::not_connected, name_);
    }
    adopt(std::move(*connection));
    thread_ = start_thread([this] { run(); });
  }

  LocalBus(const LocalBus&) = delete;
  LocalBus& operator=(const LocalBus&) = delete;
  ~LocalBus() override { close(); }

  using Bus::receive;
  using Bus::send;
  Transfer send(std::span<const Frame> frames, Timeout timeout) override;
  Transfer receive(std::span<Received> frames, Timeout timeout) override;
  void set_filters(std::span<const SocketCanFilter> filters) override;
  [[nodiscard]] int fd() const noexcept override { return queue_.readable().fd(); }
  [[nodiscard]] BusState state() const override;
  [[nodiscard]] Statistics statistics() const override;
  [[nodiscard]] std::optional<std::size_t> listeners() const override;
  void cancel() noexcept override { waits_.cancel(); }
  void resume() noexcept override { waits_.resume(); }
  void close() noexcept override;
  [[nodiscard]] const std::string& name() const noexcept override { return name_; }

 private:
  // The caller holds mutex_ for these.
  std::size_t offer(std::span<const Frame> frames);
  std::size_t take(std::span<Received> frames);
  void report_consumed();
  void flush();
  void adopt(Connection connection);
  void offer_again();
  void disconnect();
  void fetch();
  Stream::Read read();
  bool handle(const Record& record);
  bool take_delivery(const Deliver& deliver);
  void take_done(const Done& done);
  [[nodiscard]] std::size_t unacknowledged() const { return sent_[0].size() + sent_[1].size(); }

  // The reading thread.
  void run();
  void serve();
  void reconnect();
  [[nodiscard]] bool wants_to_write() const;

  std::string name_;
  Connector connector_;  // by the constructor, then by the reading thread, then by close()
  EventFlag sendable_;   // room may have come since send() found none
  EventFlag stop_;
  EventFlag wake_;  // the reading thread has bytes to send, too
  Waits waits_;

  mutable std::mutex mutex_;
  std::condition_variable all_done_;
  std::condition_variable flushed_;  // or the connection is another, or none
  std::optional<Connection> connection_;
  std::uint64_t connection_number_ = 0;
  bool over_ = false;  // the connection is, and the reading thread has not seen to it yet
  std::vector<SocketCanFilter> filters_;
  std::array<std::deque<OfferedFrame>, lane_count> sent_;  // not reported done yet
  std::array<std::size_t, lane_count> offered_{};          // of sent_, to this hub
  std::array<std::uint64_t, lane_count> sequence_{};
  LaneOrder order_;
  // The hub sees to it that it does not grow without end.
  ReceiveQueue queue_{std::numeric_limits<std::size_t>::max()};
  std::size_t queued_before_ = 0;  // of queue_, from hubs before this one
  Senders senders_;
  Statistics statistics_;
  std::uint64_t index_ = 0;      // of the delivery had last from this hub
  std::uint64_t announced_ = 0;  // losses seen as gaps in that
  std::uint64_t consumed_ = 0;
  std::uint64_t reported_ = 0;  // of consumed_, to this hub
  std::thread thread_;
};

Transfer LocalBus::send(std::span<const Frame> frames, Timeout timeout) {
  check_sendable(frames);
  return send_queued(
      waits_, sendable_, frames, timeout,
      [this](std::span<const Frame> rest) -> std::optional<std::size_t> {
        const std::lock_guard lock(mutex_);
        if (waits_.is_closed()) {
          return std::nullopt;
        }
        const std::size_t offered = offer(rest);
        if (offered < rest.size()) {
          sendable_.clear();
        }
        return offered;
      },
      [this](bool gives_up) {
        const std::lock_guard lock(mutex_);
        ++(gives_up ? statistics_.send_timeouts : statistics_.send_waits);
      });
}

// As many as fit in their lanes' windows, up to the first that does not, or whose turn has not
// come.
std::size_t LocalBus::offer(std::span<const Frame> frames) {
  if (!connection_) {
    return 0;
  }
  Stream& stream = connection_->stream;
  std::size_t count = 0;
  for (const Frame& frame : frames) {
    const std::size_t lane = lane_of(frame);
    if (sent_.at(lane).size() >= connection_->welcome.window ||
        !order_.admits(lane, unacknowledged() == 0)) {
      break;
    }
    order_.accepted(lane);
    sent_.at(lane).push_back({++sequence_.at(lane), to_wire(frame)});
    append_record(stream.out(), sent_.at(lane).back());
    ++offered_.at(lane);
    ++count;
  }
  statistics_.sent += count;
  flush();
  return count;
}

// The end of the connection shows to the reading thread, which sees to it.
void LocalBus::flush() {
  static_cast<void>(connection_->stream.flush());
  if (!connection_->stream.flushed()) {
    wake_.set();
  }
}

Transfer LocalBus::receive(std::span<Received> frames, Timeout timeout) {
  return receive_queued(waits_, queue_.readable(), frames, timeout,
                        [this](std::span<Received> room) -> std::optional<std::size_t> {
                          const std::lock_guard lock(mutex_);
                          return waits_.is_closed() ? std::nullopt : std::optional(take(room));
                        });
}

std::size_t LocalBus::take(std::span<Received> frames) {
  if (waits_.is_cancelled() && connection_) {
    fetch();
  }
  const std::size_t count = queue_.take(frames);
  const std::size_t before = std::min(count, queued_before_);
  queued_before_ -= before;
  consumed_ += count - before;
  report_consumed();
  return count;
}

// What has come, and the reading thread has not got round to.
void LocalBus::fetch() {
  while (queue_.size() == 0 && !over_) {
    const Stream::Read got = read();
    over_ = got == Stream::Read::end;
    if (got == Stream::Read::nothing) {
      return;
    }
  }
  if (over_) {
    wake_.set();
  }
}

void LocalBus::report_consumed() {
  if (connection_ && consumed_ - reported_ >= consumed_lot) {
    reported_ = consumed_;
    append_record(connection_->stream.out(), Consumed{consumed_});
    flush();
  }
}

void LocalBus::set_filters(std::span<const SocketCanFilter> filters) {
  if (filters.size() > max_filters) {
    throw std::system_error(Errc::too_many_filters, name_);
  }
  std::unique_lock lock(mutex_);
  filters_.assign(filters.begin(), filters.end());
  if (!connection_) {
    return;  // the next one begins with them
  }
  append_filters(connection_->stream.out(), filters_);
  flush();
  // In the socket they are before whatever anybody sends after this.
  const std::uint64_t end = connection_->stream.appended();
  const std::uint64_t number = connection_number_;
  flushed_.wait_for(lock, filter_time, [this, end, number] {
    return !connection_ || connection_number_ != number || connection_->stream.sent() >= end ||
           waits_.is_closed();
  });
}

BusState LocalBus::state() const {
  const std::lock_guard lock(mutex_);
  return connection_ ? BusState::active : BusState::absent;
}

Statistics LocalBus::statistics() const {
  const std::lock_guard lock(mutex_);
  Statistics statistics = statistics_;
  queue_.add_to(statistics);
  if (connection_) {
    const HubCounters& counters = connection_->page.counters();
    statistics.dropped += counters.dropped.load(std::memory_order_relaxed);
    statistics.unheard += counters.unheard.load(std::memory_order_relaxed);
  }
  return statistics;
}

std::optional<std::size_t> LocalBus::listeners() const {
  const std::lock_guard lock(mutex_);
  return connection_ ? std::optional<std::size_t>(
                           connection_->page.counters().listeners.load(std::memory_order_relaxed))
                     : std::nullopt;
}

void LocalBus::close() noexcept {
  {
    std::unique_lock lock(mutex_);
    if (waits_.is_closed()) {
      return;
    }
    waits_.close();
    flushed_.notify_all();
    all_done_.wait_for(lock, close_time, [this] { return unacknowledged() == 0; });
    statistics_.unsent += unacknowledged();
  }
  stop_.set();
  thread_.join();
  const std::lock_guard lock(mutex_);
  if (connection_) {
    disconnect();
  }
  connector_.leave();
}

void LocalBus::run() {
  while (!stop_.is_set()) {
    // Only this thread ends or replaces the connection, so it may look without the lock.
    if (!connection_) {
      reconnect();
      continue;
    }
    const int events = wants_to_write() ? POLLIN | POLLOUT : POLLIN;
    std::array<pollfd, 3> entries{{{connection_->stream.fd(), static_cast<short>(events), 0},
                                   {wake_.fd(), POLLIN, 0},
                                   {stop_.fd(), POLLIN, 0}}};
    static_cast<void>(::poll(entries.data(), entries.size(), -1));
    serve();
  }
}

bool LocalBus::wants_to_write() const {
  const std::lock_guard lock(mutex_);
  return !connection_->stream.flushed();
}

void LocalBus::serve() {
  const std::lock_guard lock(mutex_);
  wake_.clear();
  static_cast<void>(connection_->stream.flush());
  over_ = over_ || read() == Stream::Read::end;
  if (over_) {
    disconnect();
    ++statistics_.outages;
  }
  flushed_.notify_all();
}

/// One buffer's worth, so that the program gets its turn. @return end: also of what is no record.
Stream::Read LocalBus::read() {
  Stream& stream = connection_->stream;
  if (const Stream::Read read = stream.read(); read != Stream::Read::some) {
    return read;
  }
  Record record{};
  Split split = Split::incomplete;
  while ((split = stream.take(record)) == Split::record) {
    if (!handle(record)) {
      return Stream::Read::end;
    }
  }
  report_consumed();  // duplicates are, though nobody takes them
  return split == Split::incomplete ? Stream::Read::some : Stream::Read::end;
}

/// @return false: no hub of ours sends this.
bool LocalBus::handle(const Record& record) {
  switch (record.type) {
    case RecordType::deliver:
      return take_delivery(record.as<Deliver>());
    case RecordType::done:
      take_done(record.as<Done>());
      return true;
    default:
      return false;
  }
}

bool LocalBus::take_delivery(const Deliver& deliver) {
  const std::optional<Frame> frame = from_wire(deliver.frame);
  if (!frame || deliver.index <= index_) {
    return false;
  }
  const std::uint64_t gap = deliver.index - index_ - 1;
  index_ = deliver.index;
  announced_ += gap;
  queue_.lose(gap);
  if (!senders_.is_new(deliver.sender, lane_of(*frame), deliver.sequence)) {
    ++statistics_.duplicates;
    ++consumed_;
    return true;
  }
  const Timestamp time{std::chrono::nanoseconds(deliver.time_ns)};
  queue_.put(*frame, time);
  return true;
}

void LocalBus::take_done(const Done& done) {
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    auto& sent = sent_.at(lane);
    while (!sent.empty() && sent.front().sequence <= done.sequence.at(lane)) {
      sent.pop_front();
      offered_.at(lane) -= std::min<std::size_t>(offered_.at(lane), 1);
    }
  }
  offer_again();
  flush();
  sendable_.set();
  if (unacknowledged() == 0) {
    all_done_.notify_all();
  }
}

// What the hub had for this client and cannot give any more is lost, and told with the next frame.
void LocalBus::disconnect() {
  const HubCounters& counters = connection_->page.counters();
  const std::uint64_t lost = counters.dropped.load(std::memory_order_relaxed) +
                             counters.at_risk.load(std::memory_order_relaxed);
  statistics_.dropped += lost;
  statistics_.unheard += counters.unheard.load(std::memory_order_relaxed);
  queue_.lose(lost - std::min(lost, announced_));
  connection_.reset();
}

void LocalBus::reconnect() {
  std::optional<Connection> connection;
  try {
    connection = connector_.connect(Deadline(retry_interval), stop_);
  } catch (const std::system_error&) {
    // Another kind of hub has taken the name. state() says absent, sends time out; it may leave
    // again.
    static_cast<void>(::poll(nullptr, 0, static_cast<int>(retry_interval.count())));
  }
  if (connection) {
    const std::lock_guard lock(mutex_);
    adopt(std::move(*connection));
  }
}

void LocalBus::adopt(Connection connection) {
  connection_.emplace(std::move(connection));
  ++connection_number_;
  over_ = false;
  index_ = announced_ = consumed_ = reported_ = 0;
  queued_before_ = queue_.size();
  append_filters(connection_->stream.out(), filters_);
  offered_.fill(0);
  offer_again();
  flush();
  sendable_.set();
}

// Frames that the last hub did not report done, as many as this one lets be under way.
void LocalBus::offer_again() {
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const auto& sent = sent_.at(lane);
    std::size_t& offered = offered_.at(lane);
    while (offered < sent.size() && offered < connection_->welcome.window) {
      append_record(connection_->stream.out(), sent.at(offered++));
      ++statistics_.resent;
    }
  }
}

}  // namespace
}  // namespace local

std::unique_ptr<Bus> open_local(const std::string& bus_name,
                                std::optional<std::uint32_t> bitrate_bps,
                                const OpenOptions& options) {
  return std::make_unique<local::LocalBus>(bus_name, bitrate_bps, options);
}

}  // namespace roio
