#ifndef ROIO_SIM_BOARD_SERIAL_PORTS_HPP
#define ROIO_SIM_BOARD_SERIAL_PORTS_HPP

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "avr/board_model.hpp"
#include "avr/core.hpp"
#include "avr/serial.hpp"

namespace roio::sim {

/// A board's serial ports by Arduino's numbers, each with whoever listens to it.
class SerialPorts {
 public:
  using Listener = std::function<void(std::uint8_t)>;
  /// Lets something happen at a cycle to come.
  using Post = std::function<void(AvrCore::Cycle, std::function<void()>)>;

  SerialPorts(const BoardModel& model, Post post) : model_(model), post_(std::move(post)) {}

  void add(int number, std::unique_ptr<AvrSerial> line);
  /// In place of one before.
  void listen(int number, Listener listener) { port(number).listener = std::move(listener); }
  /// The board starts again: what was being sent is never heard.
  void reset();
  void interrupt_entered(const avr_int_vector_t& vector);

  /// Like all that take a number: @throws std::invalid_argument: the board has no such port.
  [[nodiscard]] AvrSerial& line(int number) { return *port(number).line; }
  /// The rate of the byte that its listener had last.
  [[nodiscard]] std::optional<double> sent_bps(int number) { return port(number).sent_bps; }

 private:
  struct Port {
    int number;
    std::unique_ptr<AvrSerial> line;
    Listener listener;
    std::optional<double> sent_bps;
  };

  [[nodiscard]] Port& port(int number);
  void sent(int number, AvrCore::Cycle end, std::uint8_t byte);

  const BoardModel& model_;
  Post post_;
  std::vector<Port> ports_;
  std::uint64_t era_ = 0;  // since the last restart: what was being sent dies with it
};

}  // namespace roio::sim

#endif
