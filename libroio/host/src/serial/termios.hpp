#ifndef ROIO_SERIAL_TERMIOS_HPP
#define ROIO_SERIAL_TERMIOS_HPP

#include <cstdint>

namespace roio::serial {

// termios as Linux has it, for any rate. A file of its own: <asm/termbits.h> and <termios.h> define
// the same names.

/// 8 data bits, no parity, 1 stop bit, no flow control, nothing translated; DTR stays as it is when
/// the port is closed, so that opening it once more does not reset an Arduino.
/// @return false: errno says why.
bool make_raw(int fd, std::uint32_t rate_bps);
/// @return false: errno says why.
bool set_line_rate(int fd, std::uint32_t rate_bps);

}  // namespace roio::serial

#endif
