/// `roio-cli hub`: carries a local bus, on purpose and until a signal.
#ifndef ROIO_CLI_HUB_HPP
#define ROIO_CLI_HUB_HPP

#include <string>

namespace roio::cli {

struct HubOptions {
  std::string bus;  ///< "local:robot", with a bit rate or without.
};

/// @return the exit status. @throws std::system_error.
int hub(const HubOptions& options);

}  // namespace roio::cli

#endif
