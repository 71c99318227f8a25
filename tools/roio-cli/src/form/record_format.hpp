/// What `dump` and `record` write: the frames and, where the form has a place for it, what happened
/// to the bus between them. A form is a file: text_format.cpp, log_format.cpp, json_lines.cpp,
/// csv_format.cpp, pcap_format.cpp.
#ifndef ROIO_CLI_RECORD_FORMAT_HPP
#define ROIO_CLI_RECORD_FORMAT_HPP

#include <cstddef>
#include <cstdint>
#include <memory>
#include <roio/bus.hpp>
#include <roio/robot.hpp>
#include <string>

#include "form/frame_text.hpp"
#include "form/origin.hpp"

namespace roio::cli {

enum class Form : std::uint8_t { text, log, json, csv, pcap };

/// What happened to a bus between its frames.
struct BusNews {
  enum class Kind : std::uint8_t {
    lost,       ///< `count` frames.
    not_shown,  ///< `count` CAN FD frames, since the last time or the start.
    state,      ///< It is `state` now.
  };
  Kind kind;
  std::uint64_t count = 0;
  BusState state = BusState::active;
};

/// "12 frames lost", "1 CAN FD frame not shown", "bus is down".
std::string to_text(const BusNews& news);

class RecordFormat {
 public:
  RecordFormat() = default;
  RecordFormat(const RecordFormat&) = delete;
  RecordFormat& operator=(const RecordFormat&) = delete;
  virtual ~RecordFormat() = default;

  /// Each appends whole lines with their ends, or whole records.

  /// What stands before the first frame, once.
  virtual void begin(Buffer& /*out*/) {}
  virtual void frame(Buffer& out, const Origin& from, const Received& received) = 0;
  /// @return false: the form has no place for it, so that it is for standard error.
  virtual bool news(Buffer& /*out*/, const Origin& /*from*/, const BusNews& /*news*/) {
    return false;
  }
};

struct TextStyle {
  TimeColumn::Mode time = TimeColumn::Mode::none;
  Colour colour = Colour::none;
  std::size_t bus_width = 0;               ///< Of the column with the bus's name; 0: there is none.
  std::shared_ptr<const Labels> labels{};  ///< Null: numbers.
};

/// Aligned columns for people.
std::unique_ptr<RecordFormat> text_format(const TextStyle& style);

/// Byte for byte what candump -L prints.
std::unique_ptr<RecordFormat> log_format();

/// One JSON object a line.
/// @param with_bus each names its bus, in a last field that parse_json_line() passes over.
/// @param robot whose names messages have beside their bytes; null: none.
/// @throws UsageError: this roio-cli was built without JSON.
std::unique_ptr<RecordFormat> json_format(bool with_bus,
                                          std::shared_ptr<const Robot> robot = nullptr);

/// Comma-separated values under a line of names. Numbers are decimal, or begin with 0x, and each
/// byte and each part of an address has a column: a spreadsheet reads "0.10" as 0.1.
std::unique_ptr<RecordFormat> csv_format();

/// A capture file for Wireshark: of link type LINKTYPE_CAN_SOCKETCAN, with times in nanoseconds.
/// It has no place for a bus's name.
std::unique_ptr<RecordFormat> pcap_format();

/// "1 frame", "2 frames".
std::string count_of(std::uint64_t count, const char* what);
/// "12 CAN FD frames not shown".
std::string fd_frames_not_shown(std::uint64_t count);

}  // namespace roio::cli

#endif
