// Boost.Asio: a small gateway, which forwards two frames from one bus to another. One thread, and
// no call ever waits: when one bus has no room, the other is not read until there is some.
//
// Wiring: none. Give other buses as arguments, such as "can0" or "serial:auto".
//
//   $ example_asio_forward local:robot local:copy &
//   $ example_receive local:copy &
//   $ example_send local:robot
//
// Expected output, after which it ends:
//
//   local:robot and local:copy are there
//   2 frames forwarded
#include <utility>  // Boost 1.74 forgets it

#include <array>
#include <boost/asio.hpp>
#include <exception>
#include <functional>
#include <iostream>
#include <memory>
#include <roio.hpp>
#include <span>
#include <string>
#include <vector>

namespace {

namespace asio = boost::asio;
using Descriptor = asio::posix::stream_descriptor;

/// A bus and its two descriptors, which are lent to Asio: the bus closes them itself.
class WatchedBus {
 public:
  WatchedBus(asio::io_context& context, const std::string& url)
      : bus_(roio::open(url, {.background = true})),
        frames_(context, bus_->fd()),
        events_(context, bus_->event_fd()) {}
  WatchedBus(const WatchedBus&) = delete;
  WatchedBus& operator=(const WatchedBus&) = delete;
  ~WatchedBus() {
    frames_.release();
    events_.release();
  }

  roio::Bus& operator*() { return *bus_; }
  roio::Bus* operator->() { return bus_.get(); }

  /// Calls `react` each time that something has happened, until the bus is closed.
  void on_events(std::function<void(const roio::Events&)> react) {
    events_.async_wait(Descriptor::wait_read, [this, react](boost::system::error_code error) {
      if (error) {
        return;
      }
      const roio::Events events = bus_->take_events();
      react(events);
      if (!events.closed) {
        on_events(react);
      }
    });
  }
  /// Calls `react` once, when there are frames.
  void on_frames(std::function<void()> react) {
    frames_.async_wait(Descriptor::wait_read, [react](boost::system::error_code error) {
      if (!error) {
        react();
      }
    });
  }
  void close() {
    frames_.cancel();
    bus_->begin_close();
  }

 private:
  std::unique_ptr<roio::Bus> bus_;
  Descriptor frames_;
  Descriptor events_;
};

class Forwarder {
 public:
  Forwarder(asio::io_context& context, const std::string& from, const std::string& to)
      : from_(context, from), to_(context, to) {
    from_.on_events([this](const roio::Events& events) { look(from_, events); });
    to_.on_events([this](const roio::Events& events) { look(to_, events); });
    read_on();
  }

 private:
  void look(WatchedBus& bus, const roio::Events& events) {
    if (events.state) {
      if (const auto trouble = bus->trouble()) {
        std::cerr << trouble->what() << '\n';
      }
      tell_when_both_are_there();
    }
    if (events.loss) {
      std::cerr << bus->name() << ": " << bus->statistics().dropped << " frames lost\n";
    }
    if (events.room && &bus == &to_) {
      send();
    }
  }

  void tell_when_both_are_there() {
    if (!told_ && from_->state() == roio::BusState::active &&
        to_->state() == roio::BusState::active) {
      told_ = true;
      std::cout << from_->name() << " and " << to_->name() << " are there" << std::endl;
    }
  }

  void read_on() {
    from_.on_frames([this] {
      std::array<roio::Received, 64> received;
      const roio::Transfer transfer = from_->receive(received, roio::no_wait);
      for (const roio::Received& one : std::span(received).first(transfer.count)) {
        waiting_.push_back(one.frame);
      }
      send();
    });
  }

  // What finds no room stays, and is sent when room is told.
  void send() {
    const roio::Transfer transfer = to_->send(waiting_, roio::no_wait);
    waiting_.erase(waiting_.begin(),
                   waiting_.begin() + static_cast<std::ptrdiff_t>(transfer.count));
    forwarded_ += transfer.count;
    if (forwarded_ >= 2) {
      std::cout << forwarded_ << " frames forwarded\n";
      from_.close();
      to_.close();
    } else if (waiting_.empty()) {
      read_on();
    }
  }

  WatchedBus from_;
  WatchedBus to_;
  std::vector<roio::Frame> waiting_;
  std::size_t forwarded_ = 0;
  bool told_ = false;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: example_asio_forward FROM TO\n";
    return 2;
  }
  try {
    asio::io_context context;
    const Forwarder forwarder(context, argv[1], argv[2]);
    context.run();
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
