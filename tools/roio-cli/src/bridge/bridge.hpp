/// `roio-cli bridge show`, `set` and `identify`: what a bridge on a serial port is, and is told.
#ifndef ROIO_CLI_BRIDGE_HPP
#define ROIO_CLI_BRIDGE_HPP

#include <chrono>
#include <cstdint>
#include <optional>
#include <roio/bridge.hpp>
#include <string>

namespace roio::cli {

struct BridgeShowOptions {
  std::string port;  ///< As open() takes it: "serial:/dev/ttyACM0".
  bool json = false;
};

/// What is none stays as it is.
struct BridgeSetOptions {
  std::string port;
  std::optional<std::uint32_t> bitrate_bps;
  std::optional<BridgeMode> mode;
  bool set_address = false;
  std::optional<Address> address;  ///< None: the bridge is no node.
};

struct BridgeIdentifyOptions {
  std::string port;
  std::chrono::seconds duration{5};
};

/// Each: @return the exit status. @throws UsageError, Failure, BrokenPipe, std::system_error.
int bridge_show(const BridgeShowOptions& options);
int bridge_set(const BridgeSetOptions& options);
int bridge_identify(const BridgeIdentifyOptions& options);

}  // namespace roio::cli

#endif
