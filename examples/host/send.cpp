// Sends: a program that is node 0.10 tells node 0.2 three servo angles, then everybody to go.
//
// Wiring: none. Buses between programs need no hardware; give "can0" as argument for a real one.
// Start example_receive or `roio-cli dump local:robot` first, so that somebody listens.
//
// Expected output:
//
//   sent 90 45 0 to 0.2
//   sent 1 to 0.*
#include <array>
#include <cstdint>
#include <exception>
#include <iostream>
#include <roio.hpp>
#include <span>

namespace {

using Bytes = std::span<const std::uint8_t>;

bool send(roio::Node& node, roio::Address to, Bytes data) {
  const roio::Result result = node.send(to, data);
  if (result != roio::Result::ok) {
    std::cerr << "not sent to " << to_string(to) << ": " << to_string(result) << ", the bus is "
              << to_string(node.bus().state()) << '\n';
    return false;
  }
  std::cout << "sent";
  for (const unsigned byte : data) {
    std::cout << ' ' << byte;
  }
  std::cout << " to " << to_string(to) << '\n';
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  const char* const url = argc > 1 ? argv[1] : "local:robot";
  constexpr roio::Address arm{0, 2};
  constexpr std::array<std::uint8_t, 3> angles{90, 45, 0};
  constexpr std::array<std::uint8_t, 1> go{1};
  try {
    roio::Node node(roio::open(url), roio::Address{0, 10});
    if (!send(node, arm, angles) || !send(node, roio::broadcast_of(0), go)) {
      return 1;
    }
    // Hands over what still waits; the destructor would too, but could not say how it went.
    node.bus().close();
    if (node.bus().statistics().unsent > 0) {
      std::cerr << "the bus closed before everything was handed over\n";
      return 1;
    }
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
