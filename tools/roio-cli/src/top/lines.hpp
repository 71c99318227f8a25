/// `roio-cli top` into a pipe: an interval as JSON lines, one of the bus and one for each row.
#ifndef ROIO_CLI_TOP_LINES_HPP
#define ROIO_CLI_TOP_LINES_HPP

#include <roio/robot.hpp>

#include "form/frame_text.hpp"
#include "top/snapshot.hpp"

namespace roio::cli {

/// The rows by source, then destination.
/// @throws UsageError: this roio-cli was built without JSON (json_missing.cpp).
void append_json(Buffer& out, const Snapshot& snapshot, const Robot* robot);

}  // namespace roio::cli

#endif
