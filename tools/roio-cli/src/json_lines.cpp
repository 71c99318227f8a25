#include "json_lines.hpp"

#include <iterator>
#include <roio/json.hpp>
#include <string>

#include "record_format.hpp"

namespace roio::cli {
namespace {

const char* kind_name(FrameKind kind) {
  switch (kind) {
    case FrameKind::standard:
      return "standard";
    case FrameKind::standard_remote:
      return "standard-remote";
    case FrameKind::extended:
      return "extended";
    case FrameKind::extended_remote:
      return "extended-remote";
    case FrameKind::error:
      break;
  }
  return "error";
}

// Messages are what parse_json() reads; whatever else happens on a bus has another type.
class JsonFormat final : public RecordFormat {
 public:
  void frame(Buffer& out, const Received& received) override {
    JsonMessage json;
    if (to_message(received.frame, json.message) != Status::ok) {
      foreign(out, received);
      return;
    }
    json.has_source = true;
    json.time = received.time;
    const std::string line = to_json(json);
    out.append(line.data(), line.data() + line.size());
    out.push_back('\n');
  }
  void lost(Buffer& out, std::uint64_t count) override {
    fmt::format_to(std::back_inserter(out), "{{\"type\":\"lost\",\"frames\":{}}}\n", count);
  }
  void state(Buffer& out, BusState state) override {
    fmt::format_to(std::back_inserter(out), "{{\"type\":\"state\",\"state\":\"{}\"}}\n",
                   to_string(state));
  }

 private:
  static void foreign(Buffer& out, const Received& received) {
    const Frame& frame = received.frame;
    const std::size_t bytes = is_remote(frame.kind) ? 0 : std::min<std::size_t>(frame.length, 8);
    const auto us =
        std::chrono::duration_cast<std::chrono::microseconds>(received.time.time_since_epoch())
            .count();
    fmt::format_to(std::back_inserter(out),
                   "{{\"type\":\"CAN\",\"kind\":\"{}\",\"id\":{},\"length\":{},\"data\":[{}],"
                   "\"timestamp\":{}.{:06}}}\n",
                   kind_name(frame.kind), frame.id, frame.length,
                   fmt::join(frame.data, frame.data + bytes, ","), us / 1'000'000, us % 1'000'000);
  }
};

}  // namespace

Parsed<JsonMessage> parse_json_line(std::string_view line) {
  return parse_json(line);
}

std::unique_ptr<RecordFormat> json_format() {
  return std::make_unique<JsonFormat>();
}

}  // namespace roio::cli
