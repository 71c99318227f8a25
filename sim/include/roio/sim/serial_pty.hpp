/// SerialPty: a UART of a simulated board as a terminal of this computer, for programs that open a
/// serial port.
///
///   sim::SerialPty port(bus, board, 0, {.link = "/tmp/ttyACM0"});
///   std::printf("%s\n", port.path().c_str());  // such as /dev/pts/3
///   port.unplug();                             // the program at the other end sees a hang-up
///   port.plug();                               // /tmp/ttyACM0 leads to a new terminal
///
/// Rates: as long as the rate that the terminal is set to and the board's own differ by more than
/// 4.5 %, bytes arrive as a UART at the wrong rate hears them, both ways: as others, as fewer, as
/// more. A terminal whose rate no program has set has the board's, whatever that is, so that `cat`
/// works. What was set stays set until it is unplugged.
///
/// Time: what the program at the other end writes is looked for, and what the board has sent is
/// handed on, once in an interval of simulated time. Bytes that the terminal has no room for are
/// lost, and counted.
///
/// Not modelled: DTR (opening it does not reset the board), parity, USB's own delays, power (plug()
/// does not reset the board). A program's exclusive use (TIOCEXCL) does not end with it.
#ifndef ROIO_SIM_SERIAL_PTY_HPP
#define ROIO_SIM_SERIAL_PTY_HPP

#include <cstdint>
#include <filesystem>
#include <memory>
#include <roio/sim/board.hpp>
#include <string>

namespace roio::sim {

struct SerialPtyOptions {
  /// Above 0. 50 us is half a record of the bridge at 2 Mbaud; each look costs a system call.
  SimTime interval = std::chrono::microseconds(50);
  /// A symbolic link that leads to the terminal while there is one. What is there already is
  /// replaced only if it is a link to a pseudo terminal.
  std::filesystem::path link{};
};

class SerialPty {
 public:
  /// Takes the place of on_serial(). Board and bus must outlive it.
  /// @throws std::system_error: no terminal to be had, or the link cannot be made;
  ///         std::invalid_argument: no such UART, or an interval that is not above 0.
  SerialPty(CanBus& bus, Board& board, int uart, const SerialPtyOptions& options = {});
  ~SerialPty();
  SerialPty(const SerialPty&) = delete;
  SerialPty& operator=(const SerialPty&) = delete;

  /// The terminal's, not the link's; empty while unplugged.
  [[nodiscard]] const std::string& path() const;

  /// The terminal disappears: a program that has it open reads its end, and cannot write (EIO).
  void unplug();
  /// A new terminal, if there is none.
  /// @throws std::system_error: as the constructor.
  void plug();
  [[nodiscard]] bool is_plugged() const;

  /// Bytes of the board for which the terminal had no room.
  [[nodiscard]] std::uint64_t lost() const;
  /// Bytes of the board while there was no terminal.
  [[nodiscard]] std::uint64_t unheard() const;
  /// Bytes sent, either way, at a rate that the other end did not have.
  [[nodiscard]] std::uint64_t garbled() const;
  /// Of these the ones whose program had a wrong rate: no byte has come through for 2 s or since it
  /// was plugged in. The rest is a change of rate, which two ends never make at the same moment;
  /// a protocol that changes it expects that, and repeats.
  [[nodiscard]] std::uint64_t garbled_by_wrong_rate() const;

 private:
  class Line;
  std::shared_ptr<Line> line_;
  Board& board_;
  int uart_;
};

}  // namespace roio::sim

#endif
