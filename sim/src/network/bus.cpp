#include "network/bus.hpp"

#include <roio/error.hpp>
#include <roio/parts/deadline.hpp>
#include <roio/parts/frame_check.hpp>
#include <roio/parts/queued_calls.hpp>
#include <system_error>
#include <utility>

namespace roio::sim {
namespace {

constexpr std::chrono::seconds close_time{1};
constexpr std::size_t max_filters = 512;  // as many as SocketCAN takes

class NetworkBus final : public Bus {
 public:
  NetworkBus(std::shared_ptr<NetworkCore> core, const OpenOptions& options)
      : core_(std::move(core)), exchange_(std::make_shared<Exchange>(options)) {
    const Deadline deadline(options.open_timeout);
    bool joined = false;
    do {
      core_->call([this, &joined] { joined = core_->add(exchange_); });
    } while (!joined && !deadline.passed());
    if (!joined) {
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
  void begin_set_filters(std::span<const SocketCanFilter> filters) override;
  [[nodiscard]] int fd() const noexcept override { return exchange_->readable().fd(); }
  [[nodiscard]] int event_fd() const noexcept override { return exchange_->events().fd(); }
  Events take_events() override { return exchange_->events().take(); }
  [[nodiscard]] BusState state() const override { return exchange_->state(); }
  [[nodiscard]] Statistics statistics() const override { return exchange_->statistics(); }
  void cancel() noexcept override { waits_.cancel(); }
  void resume() noexcept override { waits_.resume(); }
  void close() noexcept override;
  void begin_close() noexcept override;
  [[nodiscard]] const std::string& name() const noexcept override { return core_->options().name; }

 private:
  std::shared_ptr<NetworkCore> core_;
  std::shared_ptr<Exchange> exchange_;
  Waits waits_;
};

Transfer NetworkBus::send(std::span<const Frame> frames, Timeout timeout) {
  check_sendable(frames);
  return send_queued(
      waits_, exchange_->events(), frames, timeout,
      [this](std::span<const Frame> rest) -> std::optional<std::size_t> {
        if (waits_.is_closed()) {
          return std::nullopt;
        }
        const Exchange::Offered offered = exchange_->offer(rest, core_->due());
        if (offered.wake) {
          core_->wake();
        }
        return offered.count;
      },
      [this](bool gives_up) {
        if (gives_up) {
          exchange_->count_send_timeout();
        } else {
          exchange_->count_send_wait();
        }
      });
}

Transfer NetworkBus::receive(std::span<Received> frames, Timeout timeout) {
  return receive_queued(waits_, exchange_->readable(), frames, timeout,
                        [this](std::span<Received> room) -> std::optional<std::size_t> {
                          return waits_.is_closed() ? std::nullopt
                                                    : std::optional(exchange_->take(room));
                        });
}

void NetworkBus::set_filters(std::span<const SocketCanFilter> filters) {
  if (filters.size() > max_filters) {
    throw std::system_error(Errc::too_many_filters, name());
  }
  exchange_->set_filters(filters);
}

void NetworkBus::begin_set_filters(std::span<const SocketCanFilter> filters) {
  set_filters(filters);
  exchange_->events().tell(&Events::filters);
}

void NetworkBus::begin_close() noexcept {
  waits_.close();
  exchange_->begin_close(Deadline(close_time));
  core_->wake();
}

void NetworkBus::close() noexcept {
  begin_close();
  // When the simulation has ended, the station is gone with it.
  exchange_->await_left();
}

}  // namespace

std::unique_ptr<Bus> open_network_bus(std::shared_ptr<NetworkCore> core,
                                      const OpenOptions& options) {
  return std::make_unique<NetworkBus>(std::move(core), options);
}

}  // namespace roio::sim
