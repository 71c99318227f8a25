#include "serial/bus.hpp"

#include <poll.h>

#include <algorithm>
#include <array>
#include <condition_variable>
#include <mutex>
#include <roio/bridge.hpp>
#include <roio/error.hpp>
#include <roio/parts/controller_report.hpp>
#include <roio/parts/deadline.hpp>
#include <roio/parts/frame_check.hpp>
#include <roio/parts/queued_calls.hpp>
#include <roio/parts/receive_queue.hpp>
#include <roio/parts/thread.hpp>
#include <thread>
#include <utility>
#include <vector>

#include "serial/finder.hpp"
#include "serial/nonce.hpp"
#include "serial/ports.hpp"
#include "serial/pump.hpp"
#include "serial/trouble.hpp"

namespace roio {
namespace serial {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds close_time{1000};
constexpr milliseconds bye_time{200};
constexpr milliseconds retry_interval{100};  // to open the port again
// A new filter holds when the call returns, if the bridge is there to say so.
constexpr milliseconds filter_time{1000};
constexpr std::size_t max_filters = 512;  // as many as SocketCAN takes
constexpr std::size_t receive_capacity = 16384;
constexpr milliseconds clock_step{50};  // of the wall clock, that somebody has set

SerialSettings settings_of(const BusUrl& url, std::vector<serial::Rule> rules) {
  SerialSettings settings;
  settings.line_rate_bps = url.baud.value_or(settings.line_rate_bps);
  settings.bitrate_bps = url.bitrate;
  settings.mode = url.mode;
  settings.rules = std::move(rules);
  return settings;
}

/// The filters as the bridge can have them: exactly, or everything when it cannot.
std::vector<serial::Rule> rules_of(std::span<const SocketCanFilter> filters) {
  const bool fits = filters.size() <= max_rules &&
                    std::none_of(filters.begin(), filters.end(), [](const SocketCanFilter& one) {
                      return (one.can_id & socketcan::inverted) != 0;
                    });
  if (!fits) {
    return {{0, 0}};
  }
  std::vector<serial::Rule> rules;
  for (const SocketCanFilter& filter : filters) {
    const std::uint32_t mask = effective_mask(filter);
    rules.push_back({filter.can_id & mask, mask});
  }
  return rules;
}

BusState bus_state(BridgeState state) {
  switch (state) {
    case BridgeState::active:
      return BusState::active;
    case BridgeState::warning:
      return BusState::warning;
    case BridgeState::passive:
      return BusState::passive;
    case BridgeState::bus_off:
      return BusState::bus_off;
    case BridgeState::no_controller:
    case BridgeState::stuck:
      return BusState::down;
    case BridgeState::absent:
      break;
  }
  return BusState::absent;
}

/// Of a counter of 32 bits, which begins anew when the board is reset.
std::uint32_t growth(std::uint32_t before, std::uint32_t now) {
  return now >= before ? now - before : now;
}

/// The state and the error counters as they are now; while the bridge has no controller, as they
/// were last.
ControllerView view_after(ControllerView view, const BridgeInfo& info) {
  const BusState state = bus_state(info.state);
  if (state != BusState::down && state != BusState::absent) {
    view.state = state;
  }
  view.transmit_errors = info.transmit_errors;
  view.receive_errors = info.receive_errors;
  return view;
}

/// What a condition variable can wait for.
Timeout bounded(Timeout timeout) {
  return std::clamp<Timeout>(timeout, no_wait, std::chrono::hours(1));
}

/// The steady clock's time as wall-clock time; it goes back only when somebody sets the clock back.
class WallClock {
 public:
  Timestamp at(Time time) {
    const Timestamp now = std::chrono::system_clock::now();
    const std::chrono::nanoseconds offset = now.time_since_epoch() - steady_now();
    if (!known_ || std::chrono::abs(offset - offset_) > clock_step) {
      known_ = true;
      offset_ = offset;
    }
    return Timestamp(time + offset_);
  }

 private:
  bool known_ = false;
  std::chrono::nanoseconds offset_{0};
};

/// A bridge as a bus. A thread of its own serves port and session, so that neither waits for the
/// program to call.
class SerialBus final : public Bus, public Bridge {
 public:
  SerialBus(std::string name, std::string path, const BusUrl& url, const OpenOptions& options)
      : name_(std::move(name)),
        path_(std::move(path)),
        error_frames_(options.error_frames),
        filters_(options.send_only ? std::vector<SocketCanFilter>{}
                                   : std::vector{SocketCanFilter{0, 0}}),
        session_(settings_of(url, rules_of(filters_)), random_nonce),
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
  [[nodiscard]] bool passes(const Frame& frame) const;
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
  std::vector<SocketCanFilter> filters_;
  SerialSession session_;
  std::optional<SerialPort> port_;  // replaced by the serving thread only
  bool port_failed_ = false;
  bool was_ready_ = false;  // when last looked at
  ReceiveQueue queue_{receive_capacity};
  std::uint64_t lost_before_us_ = 0;  // of the session's count, before open() returned
  std::size_t waiting_seen_ = 0;      // in the session
  Time awake_at_{0};                  // the serving thread, if nothing else wakes it
  WallClock wall_clock_;
  ControllerView view_;
  std::uint64_t counter_reports_seen_ = 0;
  BridgeCounters counters_seen_;
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
  if (filters.size() > max_filters) {
    throw std::system_error(Errc::too_many_filters, name_);
  }
  Lock lock(mutex_);
  filters_.assign(filters.begin(), filters.end());
  // Without an answer, the next session begins with them.
  await_reply(lock, filter_time, [this](SerialSession::Done done) {
    session_.set_rules(rules_of(filters_), steady_now(), std::move(done));
  });
}

bool SerialBus::passes(const Frame& frame) const {
  const std::uint32_t tagged = tagged_id(frame);
  return std::any_of(filters_.begin(), filters_.end(),
                     [tagged](const SocketCanFilter& filter) { return accepts(filter, tagged); });
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
  if (became_ready || session_.waiting() < waiting_seen_) {
    sendable_.set();
  }
  waiting_seen_ = session_.waiting();
  changed_.notify_all();
}

void SerialBus::deliver() {
  for (const SerialSession::Arrived& arrived : session_.take_arrived()) {
    queue_.lose(arrived.lost_before);
    if (passes(arrived.frame)) {
      enqueue(arrived.frame, wall_clock_.at(arrived.time));
    }
  }
}

void SerialBus::enqueue(const Frame& frame, Timestamp time) {
  if (!waits_.is_closed()) {
    queue_.put(frame, time);
  }
}

/// Reports what the bridge's counters say that happened to its controller, as SocketCAN's drivers
/// do. They come at once after a change of the state, and else once in a second.
void SerialBus::follow_controller() {
  if (counter_reports_seen_ == session_.counter_reports()) {
    return;
  }
  const bool is_first = counter_reports_seen_ == 0;
  counter_reports_seen_ = session_.counter_reports();
  const BridgeCounters before = std::exchange(counters_seen_, session_.bridge_counters());
  const ControllerView last = std::exchange(view_, view_after(view_, session_.info()));
  if (is_first) {
    return;
  }
  view_.overruns += growth(before.overflows, counters_seen_.overflows);
  view_.bus_offs += growth(before.bus_offs, counters_seen_.bus_offs);
  view_.message_errors += growth(before.message_errors, counters_seen_.message_errors);
  if (!is_news(last, view_)) {
    return;
  }
  statistics_.overruns += view_.overruns - last.overruns;
  statistics_.bus_offs += view_.bus_offs - last.bus_offs;
  ++statistics_.error_frames;
  if (error_frames_) {
    enqueue(error_report(last, view_), wall_clock_.at(steady_now()));
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
  return {line.sessions,      line.damaged,    session_.lost(), down.resent,   line.retries,
          line.failed_trials, line.step_downs, down.sent,       down.not_sent, down.unknown};
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
