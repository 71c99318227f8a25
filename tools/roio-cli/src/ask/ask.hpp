/// `roio-cli ask`: sends a message, and prints what its receiver answers.
#ifndef ROIO_CLI_ASK_HPP
#define ROIO_CLI_ASK_HPP

#include <chrono>
#include <memory>
#include <roio/message.hpp>
#include <roio/robot.hpp>
#include <string>

namespace roio::cli {

struct AskOptions {
  std::string bus;
  Message message{};
  std::shared_ptr<const Robot> robot;       ///< Whose names hold; null: none.
  std::chrono::milliseconds timeout{1000};  ///< Of the question and its answer together.
  bool json = false;
};

/// @return the exit status; 1 when no answer came in time.
/// @throws Failure (not sent in time), BrokenPipe, std::system_error.
int ask(const AskOptions& options);

}  // namespace roio::cli

#endif
