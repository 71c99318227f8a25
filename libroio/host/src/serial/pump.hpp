#ifndef ROIO_SERIAL_PUMP_HPP
#define ROIO_SERIAL_PUMP_HPP

#include <chrono>

#include "serial/port.hpp"
#include "serial/session.hpp"

namespace roio::serial {

/// The time that sessions are told.
inline Time steady_now() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

/// Gives the port what the session has for it, as far as it takes it.
/// @return false: the port is gone.
bool send_output(SerialPort& port, SerialSession& session);

/// Gives the session what has come, one buffer's worth, and the time, and the port its output.
/// @return false: the port is gone.
bool exchange(SerialPort& port, SerialSession& session);

/// Until when poll() may wait, in milliseconds; -1: for ever.
int poll_ms(Time deadline);

}  // namespace roio::serial

#endif
