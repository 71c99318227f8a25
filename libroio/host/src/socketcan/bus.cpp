#include "socketcan/bus.hpp"

#include <sys/epoll.h>

#include <array>
#include <cerrno>
#include <memory>
#include <roio/bus.hpp>
#include <roio/error.hpp>
#include <roio/parts/bus_events.hpp>
#include <roio/parts/fd.hpp>
#include <roio/parts/waits.hpp>
#include <string>
#include <system_error>

#include "socketcan/event_watch.hpp"
#include "socketcan/link.hpp"
#include "socketcan/receive.hpp"
#include "socketcan/transmit.hpp"

namespace roio {
namespace {

constexpr std::size_t max_filters = 512;  // CAN_RAW_FILTER_MAX

using Filters = std::span<const SocketCanFilter>;
constexpr std::array<SocketCanFilter, 1> everything{};  // no bit is compared

/// One descriptor that is readable when one of the two is.
UniqueFd watch(int first, int second, const std::string& name) {
  UniqueFd watcher(::epoll_create1(EPOLL_CLOEXEC));
  for (const int fd : {first, second}) {
    epoll_event event{};
    event.events = EPOLLIN;
    if (!watcher || ::epoll_ctl(watcher.get(), EPOLL_CTL_ADD, fd, &event) != 0) {
      throw std::system_error(errno, std::generic_category(), name);
    }
  }
  return watcher;
}

class SocketCanBus final : public Bus {
 public:
  SocketCanBus(const std::string& interface_name, const OpenOptions& options)
      : link_(interface_name, options.send_only ? Filters() : Filters(everything), events_,
              options.background),
        readable_(watch(link_.socket(), link_.news(), interface_name)),
        event_watch_(link_, events_),
        receiver_(link_, waits_, options.error_frames),
        transmitter_(link_, waits_, event_watch_) {}

  Transfer send(std::span<const Frame> frames, Timeout timeout) override {
    return waits_.is_closed() ? Transfer{Result::closed, 0} : transmitter_.send(frames, timeout);
  }

  Transfer receive(std::span<Received> frames, Timeout timeout) override {
    return waits_.is_closed() ? Transfer{Result::closed, 0} : receiver_.receive(frames, timeout);
  }

  void set_filters(Filters filters) override {
    if (filters.size() > max_filters) {
      throw std::system_error(Errc::too_many_filters,
                              name() + ": " + std::to_string(filters.size()));
    }
    link_.set_filters(filters);
  }

  void begin_set_filters(Filters filters) override {
    set_filters(filters);
    events_.tell(&Events::filters);
  }

  [[nodiscard]] int fd() const noexcept override { return readable_.get(); }
  [[nodiscard]] int event_fd() const noexcept override { return event_watch_.fd(); }
  Events take_events() override { return event_watch_.take(); }
  [[nodiscard]] BusState state() const override { return link_.state(); }
  [[nodiscard]] std::optional<std::system_error> trouble() const override {
    return link_.trouble();
  }

  [[nodiscard]] Statistics statistics() const override {
    Statistics statistics;
    link_.fill(statistics);
    transmitter_.fill(statistics);
    receiver_.fill(statistics);
    return statistics;
  }

  void cancel() noexcept override { waits_.cancel(); }
  void resume() noexcept override { waits_.resume(); }

  // The kernel has what send() accepted, and sends it whatever becomes of the socket. The socket
  // itself lives as long as the object, for calls in other threads that are just returning.
  void close() noexcept override {
    if (!waits_.is_closed()) {
      waits_.close();
      link_.mute();
      events_.tell(&Events::closed);
    }
  }
  void begin_close() noexcept override { close(); }

  [[nodiscard]] const std::string& name() const noexcept override { return link_.name(); }

 private:
  BusEvents events_;
  // Looking at the interface takes note of what it finds.
  mutable socketcan::Link link_;
  Waits waits_;
  UniqueFd readable_;
  socketcan::EventWatch event_watch_;
  socketcan::Receiver receiver_;
  socketcan::Transmitter transmitter_;
};

}  // namespace

std::unique_ptr<Bus> open_socketcan(const std::string& interface_name, const OpenOptions& options) {
  return std::make_unique<SocketCanBus>(interface_name, options);
}

}  // namespace roio
