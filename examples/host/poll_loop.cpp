// A loop of one's own, with plain poll(): receives as example_receive does, and no call ever waits.
//
// Wiring: none. Buses between programs need no hardware; give "can0" as argument for a real one. It
// need not be there yet: the program says why, and goes on when it is.
//
//   $ example_poll_loop &
//   $ example_send
//
// Expected output, after which it ends:
//
//   local:robot is error-active
//   from 0.10: 90 45 0
//   from 0.10: 1
//   closed
#include <poll.h>

#include <array>
#include <exception>
#include <iostream>
#include <roio.hpp>

namespace {

class Program {
 public:
  explicit Program(const char* url)
      : node_(roio::open(url, {.background = true}), roio::Address{0, 2}, {.background = true}) {}

  void run() {
    roio::Bus& bus = node_.bus();
    // Whatever else the program waits for goes here: sockets, timers, signals.
    std::array<pollfd, 2> entries{{{bus.fd(), POLLIN, 0}, {bus.event_fd(), POLLIN, 0}}};
    while (!closed_) {
      ::poll(entries.data(), entries.size(), -1);
      if (entries[0].revents != 0) {
        receive();
      }
      if (entries[1].revents != 0) {
        look(bus.take_events());
      }
      // A closed bus has no more frames, and its descriptor has nothing to say.
      entries[0].fd = left_ > 0 ? bus.fd() : -1;
    }
  }

 private:
  void receive() {
    roio::ReceivedMessage received;
    while (left_ > 0 && node_.receive(received, roio::no_wait) == roio::Result::ok) {
      if (received.lost_before > 0) {
        std::cerr << received.lost_before << " frames lost: this program is too slow for its bus\n";
      }
      std::cout << "from " << to_string(received.source()) << ':';
      for (const unsigned byte : received.data()) {
        std::cout << ' ' << byte;
      }
      std::cout << std::endl;
      if (--left_ == 0) {
        node_.bus().begin_close();
      }
    }
  }

  void look(const roio::Events& events) {
    roio::Bus& bus = node_.bus();
    if (events.closed) {
      closed_ = true;
      std::cout << "closed\n";
    } else if (events.state) {
      if (const auto trouble = bus.trouble()) {
        std::cerr << trouble->what() << '\n';
      } else {
        std::cout << bus.name() << " is " << to_string(bus.state()) << std::endl;
      }
    }
  }

  roio::Node node_;
  int left_ = 2;  // messages
  bool closed_ = false;
};

}  // namespace

int main(int argc, char** argv) {
  try {
    Program(argc > 1 ? argv[1] : "local:robot").run();
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
