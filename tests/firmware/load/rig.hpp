/// A board that runs one of the images of images.cmake (an Uno, unless told otherwise).
#ifndef ROIO_TESTS_FIRMWARE_LOAD_RIG_HPP
#define ROIO_TESTS_FIRMWARE_LOAD_RIG_HPP

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <roio/frame.hpp>
#include <roio/message.hpp>
#include <roio/sim/board.hpp>
#include <roio/sim/can_bus.hpp>
#include <roio/sim/host_node.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace roio::load {

using namespace std::chrono_literals;
using Bytes = std::vector<std::uint8_t>;

inline std::filesystem::path image(const std::string& name,
                                   sim::BoardKind kind = sim::BoardKind::uno) {
  const char* folder = kind == sim::BoardKind::uno    ? "uno"
                       : kind == sim::BoardKind::mega ? "mega"
                                                      : "leonardo";
  return std::filesystem::path(ROIO_IMAGES_DIR) / folder / (name + ".elf");
}

inline Frame frame_of(Address source, Address destination, const Bytes& data,
                      Priority priority = Priority::normal) {
  Message message{{priority, MessageClass::message, destination, source},
                  static_cast<std::uint8_t>(data.size()),
                  {}};
  std::copy(data.begin(), data.end(), message.data);
  Frame frame{};
  if (to_frame(message, frame) != Status::ok) {
    throw std::invalid_argument("no message of Roio");
  }
  return frame;
}

constexpr Address echo_address{0, 2};
constexpr Address pc_address{0, 10};
constexpr std::uint32_t echo_bps = 500'000;
constexpr auto start_up = 20ms;  // by then a sketch has begun

inline double us(sim::SimTime span) {
  return std::chrono::duration<double, std::micro>(span).count();
}
inline double seconds(sim::SimTime span) {
  return std::chrono::duration<double>(span).count();
}

/// The lines that a board prints.
class Printed {
 public:
  Printed(sim::Board& board, int uart) {
    board.on_serial(uart, [this](std::uint8_t byte) { text_ += static_cast<char>(byte); });
  }
  [[nodiscard]] const std::string& text() const { return text_; }
  void clear() { text_.clear(); }
  /// All numbers in what was printed.
  [[nodiscard]] std::vector<std::uint64_t> numbers() const {
    std::istringstream in(text_);
    std::vector<std::uint64_t> result;
    for (std::uint64_t number = 0; in >> number;) {
      result.push_back(number);
    }
    return result;
  }

 private:
  std::string text_;
};

}  // namespace roio::load

#endif
