// A line for each frame, as RFC 4180 has it but for the line's end, which is that of this system:
//
//   time,bus,kind,id,priority,class,source_subnet,source_node,destination_subnet,...
//   1436509052.249713,can0,extended,0x1000400A,normal,message,0,10,0,2,3,90,45,0,,,,,
//   1436509052.249714,can0,standard,0x123,,,,,,,2,17,34,,,,,,
//
// What is no message has no addresses; a remote request has a length and no bytes.
#include <algorithm>
#include <chrono>
#include <iterator>
#include <roio/message.hpp>
#include <roio/text.hpp>
#include <string>
#include <string_view>

#include "form/kind_name.hpp"
#include "form/record_format.hpp"

namespace roio::cli {
namespace {

constexpr std::string_view names =
    "time,bus,kind,id,priority,class,source_subnet,source_node,destination_subnet,destination_node,"
    "length,d0,d1,d2,d3,d4,d5,d6,d7\n";

// A serial port's path may hold what separates.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) {
    return text;
  }
  std::string in_quotes = "\"";
  for (const char character : text) {
    in_quotes += character == '"' ? "\"\"" : std::string(1, character);
  }
  return in_quotes + '"';
}

class CsvFormat final : public RecordFormat {
 public:
  void begin(Buffer& out) override { out.append(names); }

  void frame(Buffer& out, const Origin& from, const Received& received) override {
    const Frame& frame = received.frame;
    const auto us =
        std::chrono::duration_cast<std::chrono::microseconds>(received.time.time_since_epoch())
            .count();
    fmt::format_to(std::back_inserter(out), "{}.{:06},{},{},0x{:0{}X},", us / 1'000'000,
                   us % 1'000'000, quoted(from.bus), kind_name(frame.kind), frame.id,
                   is_extended(frame.kind) || frame.kind == FrameKind::error ? 8 : 3);
    append_header(out, frame);
    append_bytes(out, frame);
    out.push_back('\n');
  }

 private:
  static void append_header(Buffer& out, const Frame& frame) {
    Message message{};
    if (to_message(frame, message) != Status::ok) {
      out.append(std::string_view(",,,,,,"));
      return;
    }
    const Header& header = message.header;
    fmt::format_to(std::back_inserter(out), "{},{},{},{},{},{},", to_string(header.priority),
                   to_string(header.message_class), header.source.subnet, header.source.node,
                   header.destination.subnet, header.destination.node);
  }

  static void append_bytes(Buffer& out, const Frame& frame) {
    const std::size_t bytes = is_remote(frame.kind) ? 0 : std::min(frame.length, max_data_length);
    fmt::format_to(std::back_inserter(out), "{}", frame.length);
    for (std::size_t i = 0; i < max_data_length; ++i) {
      out.push_back(',');
      if (i < bytes) {
        fmt::format_to(std::back_inserter(out), "{}", frame.data[i]);
      }
    }
  }
};

}  // namespace

std::unique_ptr<RecordFormat> csv_format() {
  return std::make_unique<CsvFormat>();
}

}  // namespace roio::cli
