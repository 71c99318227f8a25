#include "form/json_lines.hpp"

#include <chrono>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <roio/json.hpp>
#include <roio/message.hpp>
#include <roio/robot_json.hpp>
#include <set>
#include <string>
#include <utility>

#include "form/kind_name.hpp"
#include "form/record_format.hpp"

namespace roio::cli {
namespace {

using Json = nlohmann::json;

// The last field of each line, where the lines are of several buses.
constexpr std::string_view bus_field = ",\"bus\":";

// Messages are what parse_json() reads; whatever else happens on a bus has another type.
class JsonFormat final : public RecordFormat {
 public:
  JsonFormat(bool with_bus, std::shared_ptr<const Robot> robot)
      : with_bus_(with_bus), robot_(std::move(robot)) {}

  void frame(Buffer& out, const Origin& from, const Received& received) override {
    JsonMessage json;
    if (to_message(received.frame, json.message) != Status::ok) {
      foreign(out, received);
    } else {
      json.has_source = true;
      json.time = received.time;
      out.append(robot_ ? to_json(json, *robot_) : to_json(json));
    }
    end_line(out, from);
  }

  bool news(Buffer& out, const Origin& from, const BusNews& news) override {
    if (news.kind == BusNews::Kind::state) {
      fmt::format_to(std::back_inserter(out), R"({{"type":"state","state":"{}"}})",
                     to_string(news.state));
    } else {
      fmt::format_to(std::back_inserter(out), R"({{"type":"{}","frames":{}}})",
                     news.kind == BusNews::Kind::lost ? "lost" : "CAN FD", news.count);
    }
    end_line(out, from);
    return true;
  }

 private:
  // The object ends with its brace.
  void end_line(Buffer& out, const Origin& from) const {
    if (with_bus_) {
      out.resize(out.size() - 1);
      fmt::format_to(std::back_inserter(out), "{}{}}}", bus_field, Json(from.bus).dump());
    }
    out.push_back('\n');
  }

  static void foreign(Buffer& out, const Received& received) {
    const Frame& frame = received.frame;
    const std::size_t bytes = is_remote(frame.kind) ? 0 : std::min<std::size_t>(frame.length, 8);
    const auto us =
        std::chrono::duration_cast<std::chrono::microseconds>(received.time.time_since_epoch())
            .count();
    fmt::format_to(std::back_inserter(out),
                   "{{\"type\":\"CAN\",\"kind\":\"{}\",\"id\":{},\"length\":{},\"data\":[{}],"
                   "\"timestamp\":{}.{:06}}}",
                   kind_name(frame.kind), frame.id, frame.length,
                   fmt::join(frame.data, frame.data + bytes, ","), us / 1'000'000, us % 1'000'000);
  }

  bool with_bus_;
  std::shared_ptr<const Robot> robot_;
};

// --- and back ------------------------------------------------------------------------------------

ParseError field_error(const std::string& name, const std::string& what) {
  return {"JSON field " + quote(name) + ": " + what, 0};
}

/// An object without a field twice; nothing for any other text.
std::optional<Json> read_object(std::string_view line) {
  std::set<std::string> seen;
  bool twice = false;
  Json json = Json::parse(
      line.begin(), line.end(),
      [&](int depth, Json::parse_event_t event, Json& value) {
        if (event == Json::parse_event_t::key && depth == 1) {
          twice = !seen.insert(value.get<std::string>()).second || twice;
        }
        return true;
      },
      false);
  return json.is_object() && !twice ? std::optional(std::move(json)) : std::nullopt;
}

std::optional<FrameKind> read_kind(const Json& value) {
  for (const FrameKind kind : {FrameKind::standard, FrameKind::standard_remote, FrameKind::extended,
                               FrameKind::extended_remote, FrameKind::error}) {
    if (value == kind_name(kind)) {
      return kind;
    }
  }
  return std::nullopt;
}

std::optional<std::uint64_t> read_whole(const Json& value, std::uint64_t largest) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > largest) {
    return std::nullopt;
  }
  return value.get<std::uint64_t>();
}

/// The data of a frame of that kind and length: as many bytes, or none of a remote request.
std::optional<ParseError> read_data(const Json& value, Frame& frame) {
  const std::size_t due = is_remote(frame.kind) ? 0 : frame.length;
  if (!value.is_array() || value.size() != due) {
    return field_error(
        "data", "expected an array of " + count_of(due, "byte") + ", as kind and length say");
  }
  for (std::size_t i = 0; i < due; ++i) {
    const auto byte = read_whole(value[i], 255);
    if (!byte) {
      return field_error("data", "expected integers 0..255");
    }
    frame.data[i] = static_cast<std::uint8_t>(*byte);
  }
  return std::nullopt;
}

/// Microseconds, which a double has until the year 2112; none where there is no such time.
std::optional<Timestamp> read_time(const Json& object) {
  constexpr double latest_s = 4e9;
  const auto field = object.find("timestamp");
  if (field == object.end() || !field->is_number()) {
    return std::nullopt;
  }
  const double seconds = field->get<double>();
  if (!(seconds >= 0 && seconds <= latest_s)) {
    return std::nullopt;
  }
  return Timestamp(std::chrono::microseconds(std::llround(seconds * 1e6)));
}

/// A frame that is no message, as JsonFormat::foreign() writes it.
Parsed<std::optional<JsonFrame>> read_foreign(const Json& object) {
  for (const char* name : {"kind", "id", "length", "data"}) {
    if (!object.contains(name)) {
      return field_error(name, "missing; a frame of type CAN has kind, id, length and data");
    }
  }
  for (const auto& [name, value] : object.items()) {
    if (name != "type" && name != "kind" && name != "id" && name != "length" && name != "data" &&
        name != "timestamp") {
      return field_error(name, "unknown in a frame of type CAN");
    }
  }
  const auto kind = read_kind(object["kind"]);
  if (!kind) {
    return field_error("kind",
                       "expected standard, standard-remote, extended, extended-remote or error");
  }
  if (*kind == FrameKind::error) {
    return std::optional<JsonFrame>();
  }
  const auto id = read_whole(object["id"], max_id(*kind));
  if (!id) {
    return field_error("id", "expected an integer 0.." + std::to_string(max_id(*kind)));
  }
  const auto length = read_whole(object["length"], max_data_length);
  if (!length) {
    return field_error("length", "expected an integer 0..8");
  }
  Frame frame{static_cast<std::uint32_t>(*id), *kind, static_cast<std::uint8_t>(*length), {}};
  if (const auto error = read_data(object["data"], frame)) {
    return *error;
  }
  return std::optional(JsonFrame{frame, read_time(object)});
}

/// What is of another type than a message; nothing when it is neither.
std::optional<Parsed<std::optional<JsonFrame>>> parse_other(std::string_view line) {
  const auto object = read_object(line);
  if (!object || !object->contains("type")) {
    return std::nullopt;
  }
  const Json& type = (*object)["type"];
  if (type == "CAN") {
    return read_foreign(*object);
  }
  if (type == "lost" || type == "CAN FD" || type == "state") {
    return std::optional<JsonFrame>();
  }
  return std::nullopt;
}

/// A line, and the bus that it comes from apart.
struct BusLine {
  std::string line;
  std::string bus;  ///< Empty: it says none.
};

BusLine take_bus_off(std::string_view line) {
  const std::size_t field = line.rfind(bus_field);
  const std::size_t brace = line.rfind('}');
  if (field == std::string_view::npos || brace == std::string_view::npos || brace < field) {
    return {std::string(line), {}};
  }
  const std::string_view value =
      line.substr(field + bus_field.size(), brace - field - bus_field.size());
  const Json name = Json::parse(value.begin(), value.end(), nullptr, false);
  if (!name.is_string()) {
    return {std::string(line), {}};
  }
  return {std::string(line.substr(0, field)) + std::string(line.substr(brace)),
          name.get<std::string>()};
}

Parsed<std::optional<JsonFrame>> parse_without_bus(const std::string& line, Address default_source,
                                                   const Robot* robot) {
  static const Robot nobody;  // names beside the bytes are passed over, as with any robot
  const auto json = parse_json(line, robot != nullptr ? *robot : nobody, default_source);
  if (!json) {
    const auto other = parse_other(line);
    return other ? *other : Parsed<std::optional<JsonFrame>>(json.error());
  }
  Message message = json->message;
  if (!json->has_source) {
    message.header.source = default_source;
  }
  Frame frame{};
  if (to_frame(message, frame) != Status::ok) {
    return ParseError{"expected a message of class message, system or stream", 0};
  }
  return std::optional(JsonFrame{frame, json->time});
}

}  // namespace

Parsed<std::optional<JsonFrame>> parse_json_line(std::string_view line, Address default_source,
                                                 const Robot* robot) {
  BusLine split = take_bus_off(line);
  auto frame = parse_without_bus(split.line, default_source, robot);
  if (!frame || !*frame) {
    return frame;
  }
  JsonFrame with_bus = **frame;
  with_bus.bus = std::move(split.bus);
  return std::optional(std::move(with_bus));
}

std::unique_ptr<RecordFormat> json_format(bool with_bus, std::shared_ptr<const Robot> robot) {
  return std::make_unique<JsonFormat>(with_bus, std::move(robot));
}

}  // namespace roio::cli
