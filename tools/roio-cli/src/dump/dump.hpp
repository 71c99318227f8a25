/// `roio-cli dump`: shows what is on a bus, or on several.
#ifndef ROIO_CLI_DUMP_HPP
#define ROIO_CLI_DUMP_HPP

#include "form/record_format.hpp"
#include "listen/listener.hpp"

namespace roio::cli {

struct DumpOptions {
  ListenOptions listen;
  Form form = Form::text;
  TimeColumn::Mode time = TimeColumn::Mode::none;
  bool colour_sources = false;
  bool bytes_only = false;  ///< Messages have no names, places have.
  bool verbose = false;
};

/// @return the exit status; 1 when the quiet time came before the count.
/// @throws UsageError, Failure, BrokenPipe, std::system_error.
int dump(const DumpOptions& options);

}  // namespace roio::cli

#endif
