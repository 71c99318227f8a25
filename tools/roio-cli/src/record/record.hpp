/// `roio-cli record`: keeps what is on a bus, or on several, in a file.
#ifndef ROIO_CLI_RECORD_HPP
#define ROIO_CLI_RECORD_HPP

#include <string>

#include "form/record_format.hpp"
#include "listen/listener.hpp"

namespace roio::cli {

struct RecordOptions {
  ListenOptions listen;
  std::string file;       ///< Empty: one named after the date.
  Form form = Form::log;  ///< Not text or json.
  bool force = false;     ///< Overwrites a file that is there.
};

/// @return the exit status; 1 when the quiet time came before the count.
/// @throws UsageError, Failure (the file is there, the disk is full), BrokenPipe,
///         std::system_error.
int record(const RecordOptions& options);

}  // namespace roio::cli

#endif
