#include "serial/bus.hpp"

#include <poll.h>

#include <algorithm>
#include <array>
#include <condition_variable>
#include <mutex>
#include <roio/bridge.hpp>
#include <roio/error.hpp>
#include <roio/parts/deadline.hpp>
#include <roio/parts/frame_check.hpp>
#include <roio/parts/queued_calls.hpp>
#include <roio/parts/receive_queue.hpp>
#include <roio/parts/thread.hpp>
#include <thread>
#include <utility>
#include <vector>

#include "serial/controller_watch.hpp"
#include "serial/filters.hpp"
#include "serial/finder.hpp"
#include "serial/nonce.hpp"
#include "serial/ports.hpp"
#include "serial/pump.hpp"
#include "serial/trouble.hpp"
#include "serial/wall_clock.hpp"

namespace roio {
namespace serial {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds close_time{1000};
constexpr milliseconds bye_time{200};
constexpr milliseconds retry_interval{100};  // to open the port again
// A new filter holds when the call returns, if the bridge is there to say so.
constexpr milliseconds filter_time{1000};
constexpr std::size_t receive_capacity = 16384;

/// What a condition variable can wait for.
Timeout bounded(Timeout timeout) {
  return std::clamp<Timeout>(timeout, no_wait, std::chrono::hours(1));
}

/// A bridge as a bus. A thread of its own serves port and session, so that neither waits for the
/// program to call.
class SerialBus final : public Bus, public Bridge {
 public:
  SerialBus(std::string name, std::string path, const BusUrl& url, const OpenOptions& options)
      : name_(std::move(name)),
        path_(std::move(path)),
        error_frames_(options.error_frames),
        filters_(!options.send_only),
        session_(settings_of(url, options, filters_.rules()), random_nonce),
        port_(std::in_place, path_, name_, base_rate_bps) {
    session_.begin(steady_now());
    flush();
    thread_ = start_thread([this] { run(); });
    try {
      await_session(options.open_timeout);
    } catch (...) {
      end_thread();
      throw;
    }
  }

  SerialBus(const SerialBus&) = delete;
  SerialBus& operator=(const SerialBus&) = delete;
  ~SerialBus() override { close(); }

  using Bus::receive;
  using Bus::send;
  Transfer send(std::span<const Frame> frames, Timeout timeout) override;
  Transfer receive(std::span<Received> frames, Timeout timeout) override;
  void set_filters(std::span<const SocketCanFilter> filters) override;
  [[nodiscard]] int fd() const noexcept override { return queue_.readable().fd(); }
  [[nodiscard]] BusState state() const override;
  [[nodiscard]] Statistics statistics() const override;
  void cancel() noexcept override { waits_.cancel(); }
  void resume() noexcept override { waits_.resume(); }
  void close() noexcept override;
  [[nodiscard]] const std::string& name() const noexcept override { return name_; }

  [[nodiscard]] BridgeInfo info() const override;
  [[nodiscard]] BridgeLineCounters line_counters() const override;
  [[nodiscard]] BridgeCounters counters(Timeout timeout) override;
  void set_bus(std::uint32_t bitrate_bps, BridgeMode mode, Timeout timeout) override;
  void set_address(std::optional<Address> address, Timeout timeout) override;
  void identify(std::chrono::seconds duration, Timeout timeout) override;

 private:
  using Lock = std::unique_lock<std::mutex>;
  using Reply = SerialSession::Reply;

  void await_session(Timeout timeout);
  void end_thread();

  // The caller holds mutex_ for these.
  [[nodiscard]] bool is_ready() const { return session_.phase() == SerialSession::Phase::ready; }
  void flush();
  void deliver();
  void enqueue(const Frame& frame, Timestamp time);
  void follow_session();
  void follow_controller();
  template <typename Ask>
  std::optional<Reply> await_reply(Lock& lock, Timeout timeout, const Ask& ask);
  template <typename Ask>
  void request(const std::string& what, Timeout timeout, const Ask& ask);

  // The serving thread.
  void run();
  void serve();
  void reopen();

  const std::string name_;
  const std::string path_;
  const bool error_frames_;
  EventFlag sendable_;  // room may have come since send() found none
  EventFlag stop_;
  EventFlag wake_;  // the serving thread is to look at the session
  Waits waits_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;  // anything that somebody may wait for
  Filters filters_;
  SerialSession session_;
  std::optional<SerialPort> port_;  // replaced by the serving thread only
  bool port_failed_ = false;
  bool was_ready_ = false;  // when last looked at
  ReceiveQueue queue_{receive_capacity};
  std::uint64_t lost_before_us_ = 0;  // of the session's count, before open() returned
  std::size_t waiting_seen_ = 0;      // in the session
  Time awake_at_{0};                  // the serving thread, if nothing else wakes it
  WallClock wall_clock_;
  ControllerWatch controller_;
  std::uint64_t counter_reports_seen_ = 0;
  Statistics statistics_;
  std::thread thread_;
};

// --- opening and closing -------------------------------------------------------------------------

void SerialBus::await_session(Timeout timeout) {
  const Deadline deadline(timeout);
  Lock lock(mutex_);
  while (!is_ready() && !trouble_of(session_, name_) && !deadline.passed()) {
    changed_.wait_for(lock, bounded(deadline.remaining()));
  }
  if (!is_ready()) {
    const auto trouble = trouble_of(session_, name_);
    throw trouble ? trouble->error : std::system_error(Errc::no_bridge, name_);
  }
  // What has come so far came while the bridge was being set up.
  static_cast<void>(session_.take_arrived());
  session_.forget_losses();
  lost_before_us_ = session_.lost();
  queue_.forget();
  statistics_ = {};
}

void SerialBus::close() noexcept {
  {
    Lock lock(mutex_);
    if (waits_.is_closed()) {
      return;
    }
    waits_.close();
    changed_.notify_all();
    changed_.wait_for(lock, close_time, [this] { return session_.all_done(); });
    session_.drop_waiting();
    await_reply(lock, bye_time, [this](SerialSession::Done done) {
      session_.leave(steady_now(), std::move(done));
    });
    session_.end();
  }
  end_thread();
}

void SerialBus::end_thread() {
  stop_.set();
  thread_.join();
  port_.reset();
}

// --- frames --------------------------------------------------------------------------------------

Transfer SerialBus::send(std::span<const Frame> frames, Timeout timeout) {
  check_sendable(frames);
  return send_queued(
      waits_, sendable_, frames, timeout,
      [this](std::span<const Frame> rest) -> std::optional<std::size_t> {
        const std::lock_guard lock(mutex_);
        if (waits_.is_closed()) {
          return std::nullopt;
        }
        const std::size_t offered = session_.offer(rest, steady_now());
        statistics_.sent += offered;
        waiting_seen_ = session_.waiting();
        flush();
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

/// What the session has for the port; what goes by time, the serving thread has to know of.
void SerialBus::flush() {
  port_failed_ = port_failed_ || (port_ && !send_output(*port_, session_));
  if (port_failed_ || !session_.output().empty() || session_.deadline() < awake_at_) {
    wake_.set();
  }
}

Transfer SerialBus::receive(std::span<Received> frames, Timeout timeout) {
  return receive_queued(waits_, queue_.readable(), frames, timeout,
                        [this](std::span<Received> room) -> std::optional<std::size_t> {
                          const std::lock_guard lock(mutex_);
                          return waits_.is_closed() ? std::nullopt
                                                    : std::optional(queue_.take(room));
                        });
}

void SerialBus::set_filters(std::span<const SocketCanFilter> filters) {
  if (filters.size() > Filters::max_count) {
    throw std::system_error(Errc::too_many_filters, name_);
  }
  Lock lock(mutex_);
  filters_.set(filters);
  // Without an answer, the next session begins with them.
  await_reply(lock, filter_time, [this](SerialSession::Done done) {
    session_.set_rules(filters_.rules(), steady_now(), std::move(done));
  });
}

BusState SerialBus::state() const {
  const std::lock_guard lock(mutex_);
  return is_ready() ? bus_state(session_.info().state) : BusState::absent;
}

Statistics SerialBus::statistics() const {
  const std::lock_guard lock(mutex_);
  Statistics statistics = statistics_;
  queue_.add_to(statistics);
  const DownFrames::Counters& down = session_.down();
  statistics.dropped += session_.lost() - lost_before_us_;
  statistics.resent = down.resent;
  statistics.unsent = down.not_sent + down.unknown + down.dropped;
  return statistics;
}

// --- the serving thread --------------------------------------------------------------------------

void SerialBus::run() {
  while (!stop_.is_set()) {
    // Only this thread ends or replaces the port, so it may look without the lock.
    if (!port_) {
      reopen();
      continue;
    }
    short events = POLLIN;
    int patience_ms = 0;
    {
      const std::lock_guard lock(mutex_);
      events = session_.output().empty() ? POLLIN : POLLIN | POLLOUT;
      awake_at_ = session_.deadline();
      patience_ms = poll_ms(awake_at_);
    }
    std::array<pollfd, 3> entries{
        {{port_->fd(), events, 0}, {wake_.fd(), POLLIN, 0}, {stop_.fd(), POLLIN, 0}}};
    static_cast<void>(::poll(entries.data(), entries.size(), patience_ms));
    serve();
  }
}

void SerialBus::serve() {
  const std::lock_guard lock(mutex_);
  wake_.clear();
  if (port_failed_ || !exchange(*port_, session_)) {
    port_failed_ = false;
    port_.reset();
    session_.end();
  }
  follow_session();
}

void SerialBus::reopen() {
  pollfd entry{stop_.fd(), POLLIN, 0};
  if (::poll(&entry, 1, static_cast<int>(retry_interval.count())) != 0) {
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    session_.on_time(steady_now());  // frames that wait come to their end
    follow_session();
  }
  try {
    SerialPort port(path_, name_, base_rate_bps);
    const std::lock_guard lock(mutex_);
    port_.emplace(std::move(port));
    session_.begin(steady_now());
    flush();
  } catch (const std::system_error&) {
    // Not plugged in yet, or somebody else has it: state() says absent.
  }
}

/// What has changed with the session, for those who wait or ask.
void SerialBus::follow_session() {
  deliver();
  follow_controller();
  const bool became_ready = is_ready() && !was_ready_;
  statistics_.outages += was_ready_ && !is_ready() ? 1U : 0U;
  was_ready_ = is_ready();
  if (became_ready || session_.waiting() < waiting_seen_ || session_.all_done()) {
    sendable_.set();
  }
  waiting_seen_ = session_.waiting();
  changed_.notify_all();
}

void SerialBus::deliver() {
  for (const SerialSession::Arrived& arrived : session_.take_arrived()) {
    queue_.lose(arrived.lost_before);
    if (filters_.pass(arrived.frame)) {
      enqueue(arrived.frame, wall_clock_.at(arrived.time));
    }
  }
}

void SerialBus::enqueue(const Frame& frame, Timestamp time) {
  if (!waits_.is_closed()) {
    queue_.put(frame, time);
  }
}

void SerialBus::follow_controller() {
  if (std::exchange(counter_reports_seen_, session_.counter_reports()) ==
      session_.counter_reports()) {
    return;
  }
  const auto news = controller_.take(session_.bridge_counters(), session_.info());
  if (!news) {
    return;
  }
  statistics_.overruns += news->overruns;
  statistics_.bus_offs += news->bus_offs;
  ++statistics_.error_frames;
  if (error_frames_) {
    enqueue(news->report, wall_clock_.at(steady_now()));
  }
}

// --- the bridge ----------------------------------------------------------------------------------

BridgeInfo SerialBus::info() const {
  const std::lock_guard lock(mutex_);
  BridgeInfo info = session_.info();
  info.port = path_;
  return info;
}

BridgeLineCounters SerialBus::line_counters() const {
  const std::lock_guard lock(mutex_);
  const SerialSession::Counters& line = session_.counters();
  const DownFrames::Counters& down = session_.down();
  return {line.sessions, line.damaged,       session_.lost(), down.resent,
          line.retries,  line.failed_trials, line.step_downs, down.sent,
          down.not_sent, down.unknown,       down.dropped,    session_.unsettled()};
}

BridgeCounters SerialBus::counters(Timeout timeout) {
  Lock lock(mutex_);
  const std::uint64_t before = session_.counter_reports();
  session_.ask_counters(steady_now());
  flush();
  if (!changed_.wait_for(lock, bounded(timeout),
                         [this, before] { return session_.counter_reports() != before; })) {
    throw std::system_error(Errc::no_bridge, name_ + ": counters");
  }
  return session_.bridge_counters();
}

void SerialBus::set_bus(std::uint32_t bitrate_bps, BridgeMode mode, Timeout timeout) {
  request(name_ + ": bit rate " + std::to_string(bitrate_bps) + ", mode " + to_string(mode),
          timeout, [this, bitrate_bps, mode](SerialSession::Done done) {
            session_.set_bus(bitrate_bps, mode, steady_now(), std::move(done));
          });
}

void SerialBus::set_address(std::optional<Address> address, Timeout timeout) {
  const Address to_set = address.value_or(broadcast_of(0));
  request(name_ + ": address " + to_string(to_set), timeout,
          [this, to_set](SerialSession::Done done) {
            session_.set_address(to_set, steady_now(), std::move(done));
          });
}

void SerialBus::identify(std::chrono::seconds duration, Timeout timeout) {
  constexpr std::chrono::seconds longest{255};
  const auto seconds = std::clamp(duration, std::chrono::seconds(0), longest);
  request(name_ + ": identify", timeout, [this, seconds](SerialSession::Done done) {
    session_.identify(static_cast<std::uint8_t>(seconds.count()), steady_now(), std::move(done));
  });
}

/// Asks, and waits for the reply.
template <typename Ask>
std::optional<SerialSession::Reply> SerialBus::await_reply(Lock& lock, Timeout timeout,
                                                           const Ask& ask) {
  const auto reply = std::make_shared<std::optional<Reply>>();
  ask([reply](const Reply& what) { *reply = what; });
  flush();
  changed_.wait_for(lock, bounded(timeout), [&reply] { return reply->has_value(); });
  return *reply;
}

template <typename Ask>
void SerialBus::request(const std::string& what, Timeout timeout, const Ask& ask) {
  Lock lock(mutex_);
  const Reply reply = await_reply(lock, timeout, ask).value_or(Reply{});
  if (!reply.ok()) {
    throw request_error(what, reply);
  }
}

}  // namespace
}  // namespace serial

std::unique_ptr<Bus> open_serial(const BusUrl& url, const OpenOptions& options) {
  const std::string name = "serial:" + url.target;
  const Deadline deadline(options.open_timeout);
  const bool find = url.target == "auto";
  const std::string path = find ? serial::find_the_bridge(name, deadline.remaining()) : url.target;
  if (serial::is_open_anywhere(path)) {
    throw std::system_error(Errc::port_in_use, name);
  }
  return std::make_unique<serial::SerialBus>(name, path, url, options);
}

}  // namespace roio
