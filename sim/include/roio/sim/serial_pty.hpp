/// SerialPty: a UART of a simulated board as a terminal of this computer, for programs that open a
/// serial port.
///
///   sim::SerialPty port(bus, board, 0);
///   std::printf("%s\n", port.path().c_str());  // such as /dev/pts/3
///
/// What the program at the other end writes is looked for once in `interval` of simulated time, and
/// sent to the board at the rate that the board has set, whatever the terminal's own is. Bytes of
/// the board that the terminal has no room for are lost, and counted. There is no DTR on a pseudo
/// terminal: opening it does not reset the board.
#ifndef ROIO_SIM_SERIAL_PTY_HPP
#define ROIO_SIM_SERIAL_PTY_HPP

#include <cstdint>
#include <memory>
#include <roio/sim/board.hpp>
#include <string>

namespace roio::sim {

class SerialPty {
 public:
  /// Takes the place of on_serial(). Board and bus must outlive it.
  /// @throws std::system_error: no terminal to be had; std::invalid_argument: no such UART.
  SerialPty(CanBus& bus, Board& board, int uart, SimTime interval = std::chrono::microseconds(500));
  ~SerialPty();
  SerialPty(const SerialPty&) = delete;
  SerialPty& operator=(const SerialPty&) = delete;

  [[nodiscard]] const std::string& path() const;
  /// Bytes of the board for which there was no room.
  [[nodiscard]] std::uint64_t lost() const;

 private:
  class Link;
  std::shared_ptr<Link> link_;
  Board& board_;
  int uart_;
};

}  // namespace roio::sim

#endif
