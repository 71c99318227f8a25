#include "report.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <iterator>
#include <nlohmann/json.hpp>

#include "form/record_format.hpp"

namespace roio::sim_tool {
namespace {

using cli::count_of;

double seconds(sim::SimTime time) {
  return std::chrono::duration<double>(time).count();
}

// What a board sends is not to move the terminal's cursor about.
std::string printable(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_control = (byte < 0x20 && c != '\t') || byte == 0x7F;
    result += is_control ? fmt::format("\\x{:02X}", byte) : std::string(1, c);
  }
  return result;
}

class TextReport final : public Report {
 public:
  void servo(sim::SimTime /*time*/, const std::string& board, const std::string& pin,
             int degrees) override {
    line("{}: servo: pin {} at {} degrees\n", board, pin, degrees);
  }
  void pin(sim::SimTime /*time*/, const std::string& board, const std::string& pin,
           bool high) override {
    line("{}: output: pin {} {}\n", board, pin, high ? "high" : "low");
  }
  void serial(sim::SimTime /*time*/, const std::string& board, int uart,
              std::string_view text) override {
    if (uart == 0) {
      line("{}: serial: {}\n", board, printable(text));
    } else {
      line("{}: serial{}: {}\n", board, uart, printable(text));
    }
  }
  void can(sim::SimTime /*time*/, const std::string& board, const std::string& state,
           std::uint32_t bitrate_bps) override {
    if (bitrate_bps > 0) {
      line("{}: can: {}, {} bit/s\n", board, state, bitrate_bps);
    } else {
      line("{}: can: {}\n", board, state);
    }
  }
  void terminal(sim::SimTime /*time*/, const std::string& board, const std::string& path) override {
    line("{}: serial port: {}\n", board, path.empty() ? "unplugged" : path);
  }
  void summary(const Summary& summary) override {
    line("bus: {:.3f} s simulated, {}, load {:.1f} %, {}\n", seconds(summary.time),
         count_of(summary.frames, "frame"), summary.load * 100, count_of(summary.errors, "error"));
    if (summary.bus) {
      line("bus: {} from {}, {} to it, {} lost\n", count_of(summary.from_bus, "frame"),
           *summary.bus, summary.to_bus, summary.lost);
    }
    if (summary.behind_s > 0) {
      line("bus: {:.1f} s behind real time\n", summary.behind_s);
    }
  }

 private:
  template <typename... T>
  void line(fmt::format_string<T...> format, T&&... values) {
    fmt::format_to(std::back_inserter(out()), format, std::forward<T>(values)...);
  }
};

class JsonReport final : public Report {
 public:
  using Json = nlohmann::ordered_json;

  void servo(sim::SimTime time, const std::string& board, const std::string& pin,
             int degrees) override {
    line({{"type", "servo"}, {"board", board}, {"pin", pin}, {"degrees", degrees}}, time);
  }
  void pin(sim::SimTime time, const std::string& board, const std::string& pin,
           bool high) override {
    line({{"type", "output"}, {"board", board}, {"pin", pin}, {"high", high}}, time);
  }
  void serial(sim::SimTime time, const std::string& board, int uart,
              std::string_view text) override {
    line({{"type", "serial"}, {"board", board}, {"uart", uart}, {"text", text}}, time);
  }
  void can(sim::SimTime time, const std::string& board, const std::string& state,
           std::uint32_t bitrate_bps) override {
    line({{"type", "can"}, {"board", board}, {"state", state}, {"bitrate", bitrate_bps}}, time);
  }
  void terminal(sim::SimTime time, const std::string& board, const std::string& path) override {
    line({{"type", "serial-port"}, {"board", board}, {"path", path.empty() ? Json() : Json(path)}},
         time);
  }
  void summary(const Summary& summary) override {
    Json json{{"type", "summary"},
              {"frames", summary.frames},
              {"load", summary.load},
              {"errors", summary.errors},
              {"behind", summary.behind_s}};
    if (summary.bus) {
      json["bus"] = *summary.bus;
      json["received"] = summary.from_bus;
      json["sent"] = summary.to_bus;
      json["lost"] = summary.lost;
    }
    line(std::move(json), summary.time);
  }

 private:
  void line(Json json, sim::SimTime time) {
    json["time"] = seconds(std::chrono::duration_cast<std::chrono::microseconds>(time));
    // Bytes that are no UTF-8 become U+FFFD.
    const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
    out().append(text.data(), text.data() + text.size());
  }
};

}  // namespace

std::unique_ptr<Report> text_report() {
  return std::make_unique<TextReport>();
}
std::unique_ptr<Report> json_report() {
  return std::make_unique<JsonReport>();
}

void note(std::string_view text) noexcept {
  cli::tell("roio-sim", text);
}

}  // namespace roio::sim_tool
