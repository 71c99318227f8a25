/// `roio-cli send`: sends one message, several times if asked, or what standard input says.
#ifndef ROIO_CLI_SEND_HPP
#define ROIO_CLI_SEND_HPP

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <roio/address.hpp>
#include <roio/bus.hpp>
#include <roio/frame.hpp>
#include <roio/robot.hpp>
#include <string>

namespace roio::cli {

/// Who sends when nothing else is said: the PC's place in the original system, behind its bridge.
inline constexpr Address default_source{0, 10};

struct SendOptions {
  std::string bus;
  std::shared_ptr<const Robot> robot;  ///< Whose names lines may have; null: none.
  std::optional<Frame> frame;          ///< None: lines from standard input.
  Address source = default_source;
  std::uint64_t count = 1;  ///< Times the message goes out; 0: until a signal.
  std::chrono::milliseconds interval{0};
  std::chrono::milliseconds timeout{1000};  ///< Of each message.
  /// How long to wait, first, until somebody listens on the local bus.
  std::optional<std::chrono::milliseconds> wait;
};

/// @return the exit status; 1 when a line of the input could not be understood.
/// @throws UsageError, Failure (not sent in time), std::system_error.
int send(const SendOptions& options);

}  // namespace roio::cli

#endif
