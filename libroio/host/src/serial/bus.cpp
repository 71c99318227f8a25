#include "serial/bus.hpp"

#include <poll.h>

#include <algorithm>
#include <array>
#include <roio/error.hpp>
#include <roio/parts/frame_check.hpp>
#include <roio/parts/queued_calls.hpp>
#include <utility>

#include "serial/nonce.hpp"
#include "serial/pump.hpp"
#include "serial/serial_bus.hpp"
#include "serial/trouble.hpp"

namespace roio {
namespace serial {
namespace {

using std::chrono::milliseconds;

// Whether a bridge is there shows only when it answers, and is set up.
constexpr milliseconds least_open_time{1000};
constexpr milliseconds close_time{1000};
constexpr milliseconds bye_time{200};
// A new filter holds when the call returns, if the bridge is there to say so.
constexpr milliseconds filter_time{1000};

}  // namespace

// --- opening and closing -------------------------------------------------------------------------

SerialBus::SerialBus(const BusUrl& url, const OpenOptions& options)
    : name_("serial:" + url.target),
      error_frames_(options.error_frames),
      open_until_(std::max<Timeout>(options.open_timeout, least_open_time)),
      opener_(name_, url.target),
      path_(opener_.path()),
      filters_(!options.send_only),
      session_(settings_of(url, options, filters_.rules()), random_nonce) {
  events_.look(BusState::absent, 0);
  events_.forget();
  thread_.start([this] { run(); });
  if (!options.background) {
    await_session();
  }
}

void SerialBus::await_session() {
  Lock lock(mutex_);
  changed_.wait(lock, [this] { return is_ready() || known_trouble(); });
  if (!is_ready()) {
    const std::system_error trouble = *known_trouble();
    lock.unlock();
    close();
    throw std::system_error(trouble);
  }
  // What has come so far came while the bridge was being set up.
  static_cast<void>(session_.take_arrived());
  session_.forget_losses();
  lost_before_us_ = session_.lost();
  queue_.forget();
  statistics_ = {};
  look_for_events();
  events_.forget();
}

void SerialBus::begin_close() noexcept {
  const std::lock_guard lock(mutex_);
  if (waits_.is_closed()) {
    return;
  }
  waits_.close();
  closing_.emplace(close_time);
  stop_.set();
  wake_.set();
}

void SerialBus::close() noexcept {
  begin_close();
  thread_.join();
}

/// Closed, and as far as there is a bridge, all has been handed over and BYE said, or the time for
/// it is up.
bool SerialBus::is_over() {
  const std::lock_guard lock(mutex_);
  answer_counters(false);
  if (!closing_ || !port_) {
    return closing_.has_value();
  }
  if (!leaving_ && (session_.all_done() || closing_->passed())) {
    leaving_ = true;
    closing_.emplace(bye_time);
    session_.drop_waiting();
    session_.leave(steady_now(), [this](const Reply&) { left_ = true; });
    flush();
  }
  return left_ || (leaving_ && closing_->passed());
}

void SerialBus::finish() {
  {
    const std::lock_guard lock(mutex_);
    session_.drop_waiting();
    session_.end();
    answer_counters(true);
    port_.reset();
    look_for_events();
    changed_.notify_all();
  }
  events_.tell(&Events::closed);
}

// --- frames --------------------------------------------------------------------------------------

Transfer SerialBus::send(std::span<const Frame> frames, Timeout timeout) {
  check_sendable(frames);
  return send_queued(
      waits_, events_, frames, timeout,
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
          events_.clear_room();
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
  Lock lock(mutex_);
  // Without an answer, the next session begins with them.
  await_reply(lock, filter_time,
              [this, filters](Done done) { take_filters(filters, std::move(done)); });
}

void SerialBus::begin_set_filters(std::span<const SocketCanFilter> filters) {
  const std::lock_guard lock(mutex_);
  take_filters(filters, [this, number = filters_set_ + 1](const Reply&) {
    if (number == filters_set_) {
      events_.tell(&Events::filters);
    }
  });
  flush();
}

void SerialBus::take_filters(std::span<const SocketCanFilter> filters, Done done) {
  if (filters.size() > Filters::max_count) {
    throw std::system_error(Errc::too_many_filters, name_);
  }
  filters_.set(filters);
  ++filters_set_;
  session_.set_rules(filters_.rules(), steady_now(), std::move(done));
}

// --- what is known -------------------------------------------------------------------------------

BusState SerialBus::known_state() const {
  return is_ready() ? bus_state(session_.info().state) : BusState::absent;
}

BusState SerialBus::state() const {
  const std::lock_guard lock(mutex_);
  return known_state();
}

std::optional<std::system_error> SerialBus::known_trouble() const {
  if (is_ready()) {
    return std::nullopt;
  }
  const auto trouble = trouble_of(session_, name_);
  return trouble ? trouble->error : trouble_;
}

std::optional<std::system_error> SerialBus::trouble() const {
  const std::lock_guard lock(mutex_);
  return known_trouble();
}

Statistics SerialBus::all_statistics() const {
  Statistics statistics = statistics_;
  queue_.add_to(statistics);
  const DownFrames::Counters& down = session_.down();
  statistics.dropped += session_.lost() - lost_before_us_;
  statistics.resent = down.resent;
  statistics.unsent = down.not_sent + down.unknown + down.dropped;
  return statistics;
}

Statistics SerialBus::statistics() const {
  const std::lock_guard lock(mutex_);
  return all_statistics();
}

void SerialBus::look_for_events() {
  const Statistics statistics = all_statistics();
  events_.look(known_state(), statistics.dropped + statistics.unsent + statistics.overruns);
  const auto trouble = known_trouble();
  const std::error_code code = trouble ? trouble->code() : std::error_code();
  if (std::exchange(told_trouble_, code) != code) {
    events_.tell(&Events::state);
  }
}

// --- the serving thread --------------------------------------------------------------------------

void SerialBus::run() {
  while (!is_over()) {
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
      if (closing_ && (patience_ms < 0 || patience_ms > closing_->poll_ms())) {
        patience_ms = closing_->poll_ms();
      }
    }
    std::array<pollfd, 2> entries{{{port_->fd(), events, 0}, {wake_.fd(), POLLIN, 0}}};
    static_cast<void>(::poll(entries.data(), entries.size(), patience_ms));
    serve();
  }
  finish();
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
  if (::poll(&entry, 1, static_cast<int>(opener_.pause().count())) != 0) {
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    session_.on_time(steady_now());  // frames that wait come to their end
    follow_session();
  }
  try {
    SerialPort port = opener_.open(open_until_, stop_);
    const std::lock_guard lock(mutex_);
    path_ = opener_.path();
    port_.emplace(std::move(port));
    session_.begin(steady_now());
    flush();
    // Finding it may have taken all the time.
    open_until_ = Deadline(std::max<Timeout>(open_until_.remaining(), least_open_time));
    trouble_.reset();
    look_for_events();
  } catch (const std::system_error& error) {
    // Not plugged in yet, or somebody else has it: state() says absent.
    const std::lock_guard lock(mutex_);
    trouble_ = error;
    follow_session();
  }
}

/// What has changed with the session, for those who wait or ask.
void SerialBus::follow_session() {
  deliver();
  follow_controller();
  const bool became_ready = is_ready() && !was_ready_;
  statistics_.outages += was_ready_ && !is_ready() && !leaving_ ? 1U : 0U;
  was_ready_ = is_ready();
  if (is_ready()) {
    trouble_.reset();
  } else if (!trouble_ && open_until_.passed()) {
    trouble_.emplace(Errc::no_bridge, name_);
  }
  if (became_ready || session_.waiting() < waiting_seen_ || (is_ready() && session_.all_done())) {
    events_.set_room();
  }
  waiting_seen_ = session_.waiting();
  look_for_events();
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

}  // namespace serial

std::unique_ptr<Bus> open_serial(const BusUrl& url, const OpenOptions& options) {
  return std::make_unique<serial::SerialBus>(url, options);
}

}  // namespace roio
