#include "network_bus.hpp"

#include <poll.h>

#include <array>
#include <atomic>
#include <roio/error.hpp>
#include <system_error>
#include <utility>

#include "deadline.hpp"
#include "frame_check.hpp"

namespace roio::sim {
namespace {

constexpr std::chrono::seconds close_time{1};
constexpr std::size_t max_filters = 512;  // as many as SocketCAN takes

class NetworkBus final : public Bus {
 public:
  NetworkBus(std::shared_ptr<NetworkCore> core, const OpenOptions& options)
      : core_(std::move(core)), exchange_(std::make_shared<Exchange>(options)) {
    const Deadline deadline(options.open_timeout);
    do {
      core_->call([this] { station_ = core_->add(exchange_); });
    } while (station_ == nullptr && !deadline.passed());
    if (station_ == nullptr) {
      throw std::system_error(Errc::not_connected, name());
    }
  }

  NetworkBus(const NetworkBus&) = delete;
  NetworkBus& operator=(const NetworkBus&) = delete;
  ~NetworkBus() override { close(); }

  using Bus::receive;
  using Bus::send;
  Transfer send(std::span<const Frame> frames, Timeout timeout) override;
  Transfer receive(std::span<Received> frames, Timeout timeout) override;
  void set_filters(std::span<const SocketCanFilter> filters) override;
  [[nodiscard]] int fd() const noexcept override { return exchange_->readable().fd(); }
  [[nodiscard]] BusState state() const override { return exchange_->state(); }
  [[nodiscard]] Statistics statistics() const override { return exchange_->statistics(); }
  void cancel() noexcept override;
  void resume() noexcept override;
  void close() noexcept override;
  [[nodiscard]] const std::string& name() const noexcept override { return core_->options().name; }

 private:
  void wait(const EventFlag& flag, const Deadline& deadline) const;

  std::shared_ptr<NetworkCore> core_;
  std::shared_ptr<Exchange> exchange_;
  Station* station_ = nullptr;  // the core's, and for its thread only
  EventFlag cancel_;
  EventFlag closed_flag_;
  std::atomic<bool> cancelled_{false};
  std::atomic<bool> closed_{false};
};

Transfer NetworkBus::send(std::span<const Frame> frames, Timeout timeout) {
  check_sendable(frames);
  const Deadline deadline(timeout);
  std::size_t count = 0;
  for (;;) {
    const Exchange::Offered offered = exchange_->offer(frames.subspan(count), core_->due());
    count += offered.count;
    if (offered.wake) {
      core_->wake();
    }
    if (closed_) {
      return {Result::closed, count};
    }
    if (count == frames.size()) {
      return {Result::ok, count};
    }
    if (cancelled_) {
      return {Result::cancelled, count};
    }
    if (deadline.passed()) {
      exchange_->count_send_timeout();
      return {Result::timeout, count};
    }
    exchange_->count_send_wait();
    wait(exchange_->sendable(), deadline);
  }
}

Transfer NetworkBus::receive(std::span<Received> frames, Timeout timeout) {
  const Deadline deadline(timeout);
  for (;;) {
    if (closed_) {
      return {Result::closed, 0};
    }
    if (const std::size_t count = exchange_->take(frames); count > 0) {
      return {Result::ok, count};
    }
    if (frames.empty() || deadline.passed()) {
      return {cancelled_ ? Result::cancelled : Result::timeout, 0};
    }
    if (cancelled_) {
      return {Result::cancelled, 0};
    }
    wait(exchange_->readable(), deadline);
  }
}

void NetworkBus::set_filters(std::span<const SocketCanFilter> filters) {
  if (filters.size() > max_filters) {
    throw std::system_error(Errc::too_many_filters, name());
  }
  exchange_->set_filters(filters);
}

void NetworkBus::cancel() noexcept {
  cancelled_ = true;
  cancel_.set();
}

void NetworkBus::resume() noexcept {
  cancelled_ = false;
  cancel_.clear();
}

void NetworkBus::close() noexcept {
  if (closed_.exchange(true)) {
    return;
  }
  closed_flag_.set();
  exchange_->close(close_time);
  // When the simulation has ended, the station is gone with it.
  core_->call([this] { core_->remove(station_); });
}

/// Returns when the flag is set or the time is up, and at once when cancelled or closed.
void NetworkBus::wait(const EventFlag& flag, const Deadline& deadline) const {
  std::array<pollfd, 3> entries{
      {{flag.fd(), POLLIN, 0}, {cancel_.fd(), POLLIN, 0}, {closed_flag_.fd(), POLLIN, 0}}};
  static_cast<void>(::poll(entries.data(), entries.size(), deadline.poll_ms()));
}

}  // namespace

std::unique_ptr<Bus> open_network_bus(std::shared_ptr<NetworkCore> core,
                                      const OpenOptions& options) {
  return std::make_unique<NetworkBus>(std::move(core), options);
}

}  // namespace roio::sim
