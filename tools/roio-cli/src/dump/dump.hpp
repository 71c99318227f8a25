/// `roio-cli dump`: shows what is on a bus.
#ifndef ROIO_CLI_DUMP_HPP
#define ROIO_CLI_DUMP_HPP

#include <cstdint>
#include <optional>
#include <roio/bus.hpp>
#include <string>
#include <vector>

#include "form/frame_text.hpp"

namespace roio::cli {

struct DumpOptions {
  enum class Form : std::uint8_t { text, log, json };

  std::string bus;
  std::vector<std::string> filters;
  std::optional<std::uint64_t> count;  ///< End after so many frames shown.
  std::optional<Timeout> quiet_time;   ///< End after so long without one.
  Form form = Form::text;
  TimeColumn::Mode time = TimeColumn::Mode::none;
  bool no_foreign = false;
  bool errors = false;
  bool verbose = false;
};

/// @return the exit status; 1 when the quiet time came before the count.
/// @throws UsageError, Failure, BrokenPipe, std::system_error.
int dump(const DumpOptions& options);

}  // namespace roio::cli

#endif
