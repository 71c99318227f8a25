#include "top/lines.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <roio/message.hpp>
#include <roio/robot_json.hpp>
#include <roio/text.hpp>

#include "top/view.hpp"

namespace roio::cli {
namespace {

using Json = nlohmann::ordered_json;

// More digits would say more than is known.
double rounded(double value) {
  constexpr double digits = 10000;
  return std::round(value * digits) / digits;
}

double seconds(Timeout time) {
  return rounded(std::chrono::duration<double>(time).count());
}

template <typename T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

Json share(const std::optional<double>& value) {
  return value ? Json(rounded(*value)) : Json();
}

void append_line(Buffer& out, const Json& json) {
  // A device's name may be any bytes.
  const std::string line = json.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
  out.append(line.data(), line.data() + line.size());
}

Json bus_json(const Snapshot& snapshot) {
  Json json;
  json["type"] = "bus";
  json["bus"] = snapshot.bus;
  json["state"] = to_string(snapshot.state);
  json["bitrate"] = or_null(snapshot.bitrate_bps);
  json["load"] = share(snapshot.load.share);
  json["peakLoad"] = share(snapshot.load.peak_share);
  json["bitsPerSecond"] = rounded(snapshot.load.bits_per_s);
  json["peakBitsPerSecond"] = rounded(snapshot.load.peak_bits_per_s);
  json["framesPerSecond"] = rounded(snapshot.load.frames_per_s);
  json["frames"] = snapshot.frames;
  json["lost"] = snapshot.lost;
  json["errors"] = snapshot.errors;
  json["busOffs"] = snapshot.bus_offs;
  json["outages"] = snapshot.outages;
  json["overruns"] = snapshot.overruns;
  json["fdFrames"] = snapshot.fd_frames;
  json["rowless"] = snapshot.rowless;
  json["timestamp"] =
      std::floor(
          std::chrono::duration<double, std::micro>(snapshot.time.time_since_epoch()).count()) /
      1e6;
  return json;
}

/// What names add to a row, as in what `dump --json` writes: nothing where there are none.
void add_names(Json& json, const Message& message, const Robot& robot) {
  Json named = Json::parse(to_json(JsonMessage{message, true, std::nullopt}, robot));
  for (const char* const key : {"from", "to", "message", "fields"}) {
    if (const auto found = named.find(key); found != named.end()) {
      json[key] = std::move(*found);
    }
  }
}

Json row_json(const TrafficRow& row, const Robot* robot) {
  Json json;
  json["type"] = "row";
  Message message{};
  if (to_message(row.last, message) == Status::ok) {
    json["source"] = to_string(message.header.source);
    json["destination"] = to_string(message.header.destination);
    json["priority"] = to_string(message.header.priority);
    json["class"] = to_string(message.header.message_class);
    if (robot != nullptr) {
      add_names(json, message, *robot);
    }
  } else {
    json["id"] = row.last.id;
    json["extended"] = is_extended(row.last.kind);
    json["remote"] = is_remote(row.last.kind);
  }
  json["length"] = row.last.length;
  json["data"] = Json::array();
  json["changed"] = Json::array();
  for (std::uint8_t i = 0; i < row.last.length && !is_remote(row.last.kind); ++i) {
    json["data"].push_back(row.last.data[i]);
    if (((row.changed >> i) & 1U) != 0) {
      json["changed"].push_back(i);
    }
  }
  json["frames"] = row.frames;
  json["bits"] = row.bits;
  json["rate"] = rounded(row.rate);
  json["age"] = seconds(row.age);
  json["silent"] = row.silent;
  return json;
}

}  // namespace

void append_json(Buffer& out, const Snapshot& snapshot, const Robot* robot) {
  append_line(out, bus_json(snapshot));
  for (const TrafficRow& row : sorted(snapshot.rows, View{})) {
    append_line(out, row_json(row, robot));
  }
}

}  // namespace roio::cli
