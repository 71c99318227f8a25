#include <nlohmann/json.hpp>
#include <roio/text.hpp>

#include "bridge/counts.hpp"
#include "bridge/report.hpp"

namespace roio::cli {
namespace {

using Json = nlohmann::ordered_json;

void append_line(Buffer& out, const Json& json) {
  // A port's name may be any bytes.
  const std::string line = json.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
  out.append(line.data(), line.data() + line.size());
}

void add(Json& json, std::span<const Count> counts) {
  for (const Count& count : counts) {
    json[count.key] = count.value;
  }
}

template <typename T>
void add(Json& json, const char* key, const std::optional<T>& value) {
  if (value) {
    json[key] = *value;
  }
}

Json counts_of_board(const BridgeCounters& board) {
  Json json;
  add(json, counts_up(board));
  add(json, counts_down(board));
  add(json, counts_of_controller(board));
  return json;
}

}  // namespace

void append_json(Buffer& out, const BridgeReport& report) {
  const BridgeInfo& info = report.info;
  Json json;
  json["port"] = info.port;
  json["board"] = to_string(info.board);
  json["firmware"] = to_string(info.firmware);
  json["bitrate"] = info.bitrate_bps;
  json["realBitrate"] = info.real_bitrate_bps == 0 ? Json() : Json(info.real_bitrate_bps);
  json["mode"] = to_string(info.mode);
  json["state"] = to_string(info.state);
  json["transmitErrors"] = info.transmit_errors;
  json["receiveErrors"] = info.receive_errors;
  json["address"] = info.address ? Json(to_string(*info.address)) : Json();
  json["crystalKhz"] = info.osc_khz == 0 ? Json() : Json(info.osc_khz);
  json["interruptWired"] = info.interrupt_wired;
  json["lineRate"] = info.line_rate_matters ? Json(info.line_rate_bps) : Json();
  json["counters"] = counts_of_board(report.board);
  add(json["line"], counts_of_line(report.line));
  append_line(out, json);
}

void append_json(Buffer& out, const BusReport& report) {
  Json json;
  json["bus"] = report.bus;
  json["kind"] = report.kind;
  add(json, "state", report.state);
  add(json, "bitrate", report.bitrate_bps);
  add(json, "interfaceKind", report.interface_kind);
  add(json, "board", report.board);
  add(json, "firmware", report.firmware);
  add(json, "product", report.product);
  add(json, "error", report.why_not);
  append_line(out, json);
}

}  // namespace roio::cli
