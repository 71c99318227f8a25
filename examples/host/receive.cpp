// Receives: a program that is node 0.2, such as an arm's driver, waits for its messages.
//
// Wiring: none. Buses between programs need no hardware; give "can0" as argument for a real one.
//
//   $ example_receive &
//   $ example_send
//
// Expected output, after which it ends:
//
//   node 0.2 on local:robot
//   from 0.10, normal, to me: 90 45 0
//   from 0.10, normal, to all: 1
#include <chrono>
#include <exception>
#include <iostream>
#include <roio.hpp>

namespace {

void print(const roio::ReceivedMessage& received) {
  std::cout << "from " << to_string(received.source()) << ", "
            << to_string(received.message.header.priority) << ", "
            << (received.is_broadcast() ? "to all:" : "to me:");
  for (const unsigned byte : received.data()) {
    std::cout << ' ' << byte;
  }
  std::cout << std::endl;
}

}  // namespace

int main(int argc, char** argv) {
  const char* const url = argc > 1 ? argv[1] : "local:robot";
  try {
    roio::Node node(roio::open(url), roio::Address{0, 2});
    std::cout << "node " << to_string(node.address()) << " on " << node.bus().name() << std::endl;
    for (int count = 0; count < 2; ++count) {
      roio::ReceivedMessage received;
      const roio::Result result = node.receive(received, std::chrono::seconds(60));
      if (result != roio::Result::ok) {
        std::cerr << "nothing received: " << to_string(result) << '\n';
        return 1;
      }
      if (received.lost_before > 0) {
        std::cerr << received.lost_before << " frames lost: this program is too slow for its bus\n";
      }
      print(received);
    }
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
