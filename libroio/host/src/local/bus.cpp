#include "local/bus.hpp"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <condition_variable>
#include <mutex>
#include <new>
#include <roio/error.hpp>
#include <roio/parts/frame_check.hpp>
#include <roio/parts/queued_calls.hpp>
#include <roio/parts/thread.hpp>
#include <thread>
#include <utility>
#include <vector>

#include "local/connection.hpp"
#include "local/fork.hpp"
#include "local/inbox.hpp"
#include "local/outbox.hpp"

namespace roio {
namespace local {
namespace {

constexpr std::chrono::seconds close_time{1};
constexpr std::chrono::milliseconds retry_interval{200};

std::vector<SocketCanFilter> first_filters(const OpenOptions& options) {
  return options.send_only ? std::vector<SocketCanFilter>{}
                           : std::vector<SocketCanFilter>{SocketCanFilter{0, 0}};
}

/// The client of a local bus. A thread of its own reads, so that frames, and a hub to be replaced,
/// do not wait for the program to call.
class LocalBus final : public Bus {
 public:
  LocalBus(const std::string& bus_name, std::optional<std::uint32_t> bitrate_bps,
           const OpenOptions& options)
      : name_("local:" + bus_name),
        connector_(bus_name, bitrate_bps, options.carry),
        inbox_(connector_.client(), first_filters(options)),
        outbox_(options.in_order) {
    auto connection = connector_.connect(Deadline(options.open_timeout), stop_);
    if (!connection) {
      throw connector_.why_not();
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
  [[nodiscard]] int fd() const noexcept override { return inbox_.readable().fd(); }
  [[nodiscard]] BusState state() const override;
  [[nodiscard]] Statistics statistics() const override;
  [[nodiscard]] std::optional<std::size_t> listeners() const override;
  void cancel() noexcept override { waits_.cancel(); }
  void resume() noexcept override { waits_.resume(); }
  void close() noexcept override;
  [[nodiscard]] const std::string& name() const noexcept override { return name_; }

 private:
  /// To the hub.
  struct Link {
    Stream stream;
    UniqueFd wake;
    pid_t hub;
  };

  // The caller holds mutex_ for these.
  std::optional<std::size_t> offer(std::span<const Frame> frames);
  std::size_t take(std::span<Received> frames);
  void adopt(Connection connection);
  void settle();
  void ask_for_done();
  void flush();
  void tell_if_waited_for();

  // The reading thread.
  void run();
  void work();
  bool prepare_to_sleep();
  void sleep();
  void disconnect();
  void reconnect();

  std::string name_;
  Connector connector_;  // by the constructor, then by the reading thread, then by close()
  EventFlag sendable_;   // room may have come since send() found none
  EventFlag stop_;
  EventFlag wake_;  // the reading thread has bytes to send, too
  Waits waits_;

  mutable std::mutex mutex_;
  std::condition_variable all_done_;
  std::optional<Link> link_;  // changed by the reading thread only
  Inbox inbox_;
  Outbox outbox_;
  bool closing_ = false;
  Statistics statistics_;
  std::thread thread_;
};

Transfer LocalBus::send(std::span<const Frame> frames, Timeout timeout) {
  check_sendable(frames);
  return send_queued(
      waits_, sendable_, frames, timeout,
      [this](std::span<const Frame> rest) {
        const std::lock_guard lock(mutex_);
        return offer(rest);
      },
      [this](bool gives_up) {
        const std::lock_guard lock(mutex_);
        ++(gives_up ? statistics_.send_timeouts : statistics_.send_waits);
      });
}

// As many as fit in their lanes' windows, up to the first that does not.
std::optional<std::size_t> LocalBus::offer(std::span<const Frame> frames) {
  if (waits_.is_closed()) {
    return std::nullopt;
  }
  std::size_t count = 0;
  bool asked = false;
  while (link_ && count < frames.size()) {
    if (outbox_.offer(frames[count], link_->stream.out())) {
      ++count;
      continue;
    }
    flush();
    if (asked) {
      break;
    }
    sendable_.clear();
    ask_for_done();
    asked = true;
  }
  if (count < frames.size() && !link_) {
    sendable_.clear();
  }
  statistics_.sent += count;
  if (link_) {
    flush();
  }
  return count;
}

// Done may have moved just before the hub was asked to tell of it.
void LocalBus::ask_for_done() {
  if (Slot* const slot = inbox_.slot()) {
    slot->awaits_done.store(1, std::memory_order_seq_cst);
    settle();
  }
}

void LocalBus::settle() {
  if (const Slot* const slot = inbox_.slot()) {
    outbox_.settle(*slot);
  }
}

// The end of the connection shows to the reading thread, which sees to it.
void LocalBus::flush() {
  static_cast<void>(link_->stream.flush());
  if (!link_->stream.flushed()) {
    wake_.set();
  }
}

Transfer LocalBus::receive(std::span<Received> frames, Timeout timeout) {
  return receive_queued(waits_, inbox_.readable(), frames, timeout,
                        [this](std::span<Received> room) -> std::optional<std::size_t> {
                          const std::lock_guard lock(mutex_);
                          return waits_.is_closed() ? std::nullopt : std::optional(take(room));
                        });
}

std::size_t LocalBus::take(std::span<Received> frames) {
  while (inbox_.empty() && inbox_.fetch()) {
  }
  const std::size_t count = inbox_.take(frames);
  tell_if_waited_for();
  return count;
}

void LocalBus::tell_if_waited_for() {
  if (link_ && inbox_.must_tell()) {
    append_record(link_->stream.out(), GoOn{});
    flush();
  }
}

void LocalBus::set_filters(std::span<const SocketCanFilter> filters) {
  if (filters.size() > max_filters) {
    throw std::system_error(Errc::too_many_filters, name_);
  }
  const std::lock_guard lock(mutex_);
  inbox_.set_filters(filters);
  wake_.set();
}

BusState LocalBus::state() const {
  const std::lock_guard lock(mutex_);
  if (!link_) {
    return BusState::absent;
  }
  return is_stopped(link_->hub) ? BusState::down : BusState::active;
}

Statistics LocalBus::statistics() const {
  const std::lock_guard lock(mutex_);
  Statistics statistics = statistics_;
  inbox_.add_to(statistics);
  return statistics;
}

std::optional<std::size_t> LocalBus::listeners() const {
  const std::lock_guard lock(mutex_);
  return link_ ? std::optional(inbox_.listeners()) : std::nullopt;
}

void LocalBus::close() noexcept {
  {
    std::unique_lock lock(mutex_);
    if (waits_.is_closed()) {
      return;
    }
    waits_.close();
    closing_ = true;
    ask_for_done();
    all_done_.wait_for(lock, close_time, [this] { return outbox_.size() == 0; });
    settle();
    statistics_.unsent += outbox_.size();
  }
  stop_.set();
  thread_.join();
  connector_.end_presence();
  const std::lock_guard lock(mutex_);
  link_.reset();
  connector_.leave();
}

void LocalBus::run() {
  while (!stop_.is_set()) {
    try {
      // Only this thread ends or replaces the link, so it may look without the lock.
      if (!link_) {
        reconnect();
      } else if (prepare_to_sleep()) {
        sleep();
      }
      work();
    } catch (const std::bad_alloc&) {
      // Without memory it cannot keep up; what was lost is counted. It comes back when there is.
      disconnect();
      static_cast<void>(::poll(nullptr, 0, static_cast<int>(retry_interval.count())));
    }
  }
}

/// @return false: there is more to read.
bool LocalBus::prepare_to_sleep() {
  const std::lock_guard lock(mutex_);
  return inbox_.sleep();
}

void LocalBus::sleep() {
  bool flushed = true;
  {
    const std::lock_guard lock(mutex_);
    flushed = link_->stream.flushed();
  }
  const auto events = static_cast<short>(flushed ? POLLIN : POLLIN | POLLOUT);
  std::array<pollfd, 4> entries{{{link_->stream.fd(), events, 0},
                                 {link_->wake.get(), POLLIN, 0},
                                 {wake_.fd(), POLLIN, 0},
                                 {stop_.fd(), POLLIN, 0}}};
  static_cast<void>(::poll(entries.data(), entries.size(), -1));
  if (entries[1].revents != 0) {
    std::uint64_t count = 0;
    static_cast<void>(!::read(link_->wake.get(), &count, sizeof count));
  }
  if (entries[2].revents != 0) {
    wake_.clear();
  }
  // After its welcome a hub says nothing more, so this is its end.
  if ((entries[0].revents & (POLLIN | POLLHUP | POLLERR)) != 0) {
    disconnect();
  }
}

void LocalBus::work() {
  const std::lock_guard lock(mutex_);
  inbox_.stay_awake();
  inbox_.fetch();
  settle();
  if (closing_ && outbox_.size() > 0) {
    ask_for_done();
  }
  if (link_) {
    outbox_.offer_again(link_->stream.out());
    static_cast<void>(link_->stream.flush());
    tell_if_waited_for();
  }
  sendable_.set();
  if (outbox_.size() == 0) {
    all_done_.notify_all();
  }
}

void LocalBus::disconnect() {
  const std::lock_guard lock(mutex_);
  if (link_) {
    link_.reset();
    ++statistics_.outages;
  }
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
  settle();  // by the memory before, if this is another
  inbox_.adopt(std::move(connection.memory), connection.welcome);
  settle();
  outbox_.begin(connection.welcome.window);
  link_.emplace(Link{std::move(connection.stream), std::move(connection.wake), connection.hub});
  statistics_.resent += outbox_.offer_again(link_->stream.out());
  flush();
  sendable_.set();
}

}  // namespace
}  // namespace local

std::unique_ptr<Bus> open_local(const std::string& bus_name,
                                std::optional<std::uint32_t> bitrate_bps,
                                const OpenOptions& options) {
  return local::parents_bus(std::make_unique<local::LocalBus>(bus_name, bitrate_bps, options));
}

}  // namespace roio
