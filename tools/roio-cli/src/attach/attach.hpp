/// `roio-cli bridge attach`: a bridge on a serial port and another bus become one bus.
#ifndef ROIO_CLI_ATTACH_HPP
#define ROIO_CLI_ATTACH_HPP

#include <string>

namespace roio::cli {

struct BridgeAttachOptions {
  std::string port;  ///< As open() takes it: "serial:/dev/ttyACM0".
  std::string bus;   ///< "vcan0", "local:robot".
  bool verbose = false;
};

/// Until a signal.
/// @return the exit status. @throws UsageError, Failure, std::system_error.
int bridge_attach(const BridgeAttachOptions& options);

}  // namespace roio::cli

#endif
