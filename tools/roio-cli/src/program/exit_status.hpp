/// What roio-cli exits with, and how a command says why it cannot go on.
#ifndef ROIO_CLI_EXIT_STATUS_HPP
#define ROIO_CLI_EXIT_STATUS_HPP

#include <stdexcept>

namespace roio::cli {

inline constexpr int exit_success = 0;
inline constexpr int exit_failure = 1;
inline constexpr int exit_usage = 2;
inline constexpr int exit_signal = 128;  ///< Plus the signal's number.

/// The command line asks for something that cannot be; what() says what was expected. Exit 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The command line was right and the work failed all the same. Exit 1.
struct Failure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace roio::cli

#endif
