#include "local/bus.hpp"

#include <poll.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <new>
#include <roio/error.hpp>
#include <roio/parts/frame_check.hpp>
#include <roio/parts/queued_calls.hpp>
#include <utility>
#include <vector>

#include "local/local_bus.hpp"

namespace roio {
namespace local {
namespace {

constexpr std::chrono::seconds close_time{1};
constexpr std::chrono::milliseconds retry_interval{200};

std::vector<SocketCanFilter> first_filters(const OpenOptions& options) {
  return options.send_only ? std::vector<SocketCanFilter>{}
                           : std::vector<SocketCanFilter>{SocketCanFilter{0, 0}};
}

std::system_error out_of_memory(const std::string& name) {
  return {ENOMEM, std::generic_category(), name};
}

}  // namespace

// --- opening and closing -------------------------------------------------------------------------

LocalBus::LocalBus(const std::string& bus_name, std::optional<std::uint32_t> bitrate_bps,
                   const OpenOptions& options)
    : name_("local:" + bus_name),
      no_memory_(out_of_memory(name_)),
      connector_(bus_name, bitrate_bps, options.carry),
      open_timeout_(options.open_timeout),
      inbox_(connector_.client(), first_filters(options)),
      outbox_(options.in_order) {
  events_.look(BusState::absent, 0);
  events_.forget();
  thread_.start([this] { run(); });
  if (!options.background) {
    await_first_look();
  }
}

void LocalBus::await_first_look() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return link_ || trouble_; });
  if (!link_) {
    const std::system_error trouble = *trouble_;
    lock.unlock();
    close();
    throw std::system_error(trouble);
  }
  events_.forget();
}

void LocalBus::begin_close() noexcept {
  const std::lock_guard lock(mutex_);
  if (waits_.is_closed()) {
    return;
  }
  waits_.close();
  closing_.emplace(close_time);
  ask_for_done();
  if (outbox_.size() == 0) {
    stop_.set();
  }
  wake_.set();
}

void LocalBus::close() noexcept {
  begin_close();
  thread_.join();
}

// Closed, and nothing left to hand over, or no time.
bool LocalBus::is_over() const {
  const std::lock_guard lock(mutex_);
  return closing_ && (outbox_.size() == 0 || closing_->passed());
}

void LocalBus::finish() {
  {
    const std::lock_guard lock(mutex_);
    settle();
    statistics_.unsent += outbox_.size();
    look_for_events();
    inbox_.end();
    connector_.end_presence();
    link_.reset();
  }
  connector_.leave();
  events_.tell(&Events::closed);
}

// --- frames --------------------------------------------------------------------------------------

Transfer LocalBus::send(std::span<const Frame> frames, Timeout timeout) {
  check_sendable(frames);
  return send_queued(
      waits_, events_, frames, timeout,
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
    events_.clear_room();
    ask_for_done();
    asked = true;
  }
  sender_waits_ = count < frames.size();
  if (sender_waits_ && !link_) {
    events_.clear_room();
  }
  statistics_.sent += count;
  if (link_) {
    flush();
    watch_.begin(outbox_.settled());
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

// They are in the bus's memory at once.
void LocalBus::begin_set_filters(std::span<const SocketCanFilter> filters) {
  set_filters(filters);
  events_.tell(&Events::filters);
}

// --- what is known -------------------------------------------------------------------------------

BusState LocalBus::state() const {
  const std::lock_guard lock(mutex_);
  if (!link_) {
    return BusState::absent;
  }
  return is_stopped(link_->hub) ? BusState::down : BusState::active;
}

std::optional<std::system_error> LocalBus::trouble() const {
  const std::lock_guard lock(mutex_);
  return link_ && is_stopped(link_->hub)
             ? std::system_error(Errc::carrier_stopped, name_ + ": " + describe_process(link_->hub))
             : trouble_;
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

void LocalBus::look_for_events() {
  const BusState running = watch_.is_stopped() ? BusState::down : BusState::active;
  events_.look(link_ ? running : BusState::absent, inbox_.dropped() + statistics_.unsent);
}

// --- the reading thread --------------------------------------------------------------------------

void LocalBus::run() {
  while (!is_over()) {
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
      note_trouble(no_memory_);
      static_cast<void>(::poll(nullptr, 0, static_cast<int>(retry_interval.count())));
    }
  }
  finish();
}

/// @return false: there is more to read.
bool LocalBus::prepare_to_sleep() {
  const std::lock_guard lock(mutex_);
  return inbox_.sleep();
}

void LocalBus::sleep() {
  bool flushed = true;
  int patience_ms = -1;
  {
    const std::lock_guard lock(mutex_);
    flushed = link_->stream.flushed();
    patience_ms = closing_ ? closing_->poll_ms() : -1;
  }
  const auto events = static_cast<short>(flushed ? POLLIN : POLLIN | POLLOUT);
  std::array<pollfd, 4> entries{{{link_->stream.fd(), events, 0},
                                 {link_->wake.get(), POLLIN, 0},
                                 {wake_.fd(), POLLIN, 0},
                                 {watch_.fd(), POLLIN, 0}}};
  static_cast<void>(::poll(entries.data(), entries.size(), patience_ms));
  if (entries[1].revents != 0) {
    std::uint64_t count = 0;
    static_cast<void>(!::read(link_->wake.get(), &count, sizeof count));
  }
  if (entries[2].revents != 0) {
    wake_.clear();
  }
  if (entries[3].revents != 0) {
    const std::lock_guard lock(mutex_);
    settle();
    watch_.look(link_->hub, outbox_.settled(), outbox_.size() > 0);
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
  // The hub may have answered the last time with what was known already.
  if (sender_waits_ || outbox_.has_more() || (closing_ && outbox_.size() > 0)) {
    ask_for_done();
  }
  if (link_) {
    outbox_.offer_again(link_->stream.out());
    static_cast<void>(link_->stream.flush());
    tell_if_waited_for();
  }
  if (std::exchange(settled_seen_, outbox_.settled()) != outbox_.settled()) {
    make_room();
  }
  look_for_events();
}

void LocalBus::disconnect() {
  const std::lock_guard lock(mutex_);
  if (link_) {
    link_.reset();
    ++statistics_.outages;
    look_for_events();
  }
}

void LocalBus::reconnect() {
  const Timeout time = std::exchange(has_looked_, true) ? retry_interval : open_timeout_;
  try {
    if (auto connection = connector_.connect(Deadline(time), stop_)) {
      const std::lock_guard lock(mutex_);
      adopt(std::move(*connection));
      return;
    }
    note_trouble(connector_.why_not());
  } catch (const std::system_error& error) {
    // Another kind of hub has taken the name. state() says absent, sends time out; it may leave
    // again.
    note_trouble(error);
    pollfd entry{stop_.fd(), POLLIN, 0};
    static_cast<void>(::poll(&entry, 1, static_cast<int>(retry_interval.count())));
  }
}

void LocalBus::note_trouble(const std::system_error& trouble) {
  const std::lock_guard lock(mutex_);
  if (!closing_ && (!trouble_ || trouble_->code() != trouble.code())) {
    events_.tell(&Events::state);
  }
  trouble_ = trouble;
  changed_.notify_all();
}

void LocalBus::adopt(Connection connection) {
  settle();  // by the memory before, if this is another
  outbox_.settle(inbox_.carried_before(connection.welcome));
  inbox_.adopt(std::move(connection.memory), connection.welcome);
  settle();
  outbox_.begin(connection.welcome.window);
  link_.emplace(Link{std::move(connection.stream), std::move(connection.wake), connection.hub});
  statistics_.resent += outbox_.offer_again(link_->stream.out());
  flush();
  trouble_.reset();
  watch_.reset();
  if (outbox_.size() > 0) {
    watch_.begin(outbox_.settled());
  }
  make_room();
  look_for_events();
  changed_.notify_all();
}

void LocalBus::make_room() {
  if (std::exchange(sender_waits_, false)) {
    events_.set_room();
  }
}

}  // namespace local

std::unique_ptr<Bus> open_local(const std::string& bus_name,
                                std::optional<std::uint32_t> bitrate_bps,
                                const OpenOptions& options) {
  return std::make_unique<local::LocalBus>(bus_name, bitrate_bps, options);
}

}  // namespace roio
