/// `roio-cli attach`: two buses become one.
#ifndef ROIO_CLI_ATTACH_HPP
#define ROIO_CLI_ATTACH_HPP

#include <string>

namespace roio::cli {

struct AttachOptions {
  std::string first;  ///< As open() takes it: "serial:/dev/ttyACM0", "vcan0", "local:robot".
  std::string second;
  bool verbose = false;
};

/// Until a signal, or a storm: frames that go round for ever.
/// @return the exit status. @throws UsageError, Failure, std::system_error.
int attach(const AttachOptions& options);

}  // namespace roio::cli

#endif
