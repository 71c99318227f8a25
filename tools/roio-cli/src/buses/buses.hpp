/// `roio-cli buses`: lists what can be opened.
#ifndef ROIO_CLI_BUSES_HPP
#define ROIO_CLI_BUSES_HPP

namespace roio::cli {

struct BusesOptions {
  bool json = false;
};

/// @return the exit status: 0 also when there is none.
/// @throws UsageError (no JSON in this build), Failure, BrokenPipe, std::system_error.
int buses(const BusesOptions& options);

}  // namespace roio::cli

#endif
