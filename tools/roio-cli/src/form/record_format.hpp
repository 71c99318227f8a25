/// What `dump` writes: the frames and, between them, what happened to the bus, in one of three
/// forms.
#ifndef ROIO_CLI_RECORD_FORMAT_HPP
#define ROIO_CLI_RECORD_FORMAT_HPP

#include <cstdint>
#include <memory>
#include <roio/bus.hpp>
#include <roio/robot.hpp>
#include <string>

#include "form/frame_text.hpp"

namespace roio::cli {

class RecordFormat {
 public:
  RecordFormat() = default;
  RecordFormat(const RecordFormat&) = delete;
  RecordFormat& operator=(const RecordFormat&) = delete;
  virtual ~RecordFormat() = default;

  /// Each appends whole lines with their ends.
  virtual void frame(Buffer& out, const Received& received) = 0;
  virtual void lost(Buffer& out, std::uint64_t count) = 0;
  /// CAN FD frames that have come since the last time, or the start.
  virtual void not_shown(Buffer& out, std::uint64_t fd_frames) = 0;
  virtual void state(Buffer& out, BusState state) = 0;
};

/// Aligned columns for people.
std::unique_ptr<RecordFormat> text_format(TimeColumn::Mode time, bool colour);

/// Byte for byte what candump -L prints; what happened between the frames goes to standard error.
/// @param interface_name as the log is to name it.
std::unique_ptr<RecordFormat> log_format(std::string interface_name);

/// One JSON object a line (json_lines.cpp).
/// @param robot whose names messages have beside their bytes; null: none.
/// @throws UsageError: this roio-cli was built without JSON.
std::unique_ptr<RecordFormat> json_format(std::shared_ptr<const Robot> robot = nullptr);

/// "1 frame", "2 frames".
std::string count_of(std::uint64_t count, const char* what);
/// "12 CAN FD frames not shown".
std::string fd_frames_not_shown(std::uint64_t count);

}  // namespace roio::cli

#endif
