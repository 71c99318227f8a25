#include "record/play_words.hpp"

#include <charconv>
#include <limits>

#include "program/words.hpp"

namespace roio::cli {
namespace {

constexpr const char* examples =
    R"(FILE is a log as record, candump -l and dump --log write it, or dump --json's
lines; - is standard input. Frames go out exactly in the order of the log, each
when the log says; a frame that has no time follows the one before. With BUS all
go there; BUS=NAME, as canplayer has it, is for those that the log has of NAME.

Examples:
  roio-cli play drive.log vcan0
  roio-cli play drive.log vcan0=can0 vcan1=can1
  roio-cli play --speed 10 --gap 1000 drive.log local:robot
  roio-cli play --from +60 --to +90 --loop drive.log local:robot
  zcat drive.log.gz | roio-cli play --speed max - vcan0)";

double parse_speed(const std::string& text) {
  constexpr double slowest = 0.001;
  constexpr double fastest = 1000;
  double value = 0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value, std::chars_format::fixed);
  if (error != std::errc() || end != last || !(value >= slowest && value <= fastest)) {
    throw UsageError("--speed: expected a number 0.001..1000 or max, found " + quote(text));
  }
  return value;
}

LogTime parse_time(const char* option, const std::string& text) {
  return value_or_refuse(parse_log_time(text), (std::string(option) + ": ").c_str());
}

}  // namespace

PlayWords::PlayWords(CLI::App& program)
    : app_(program.add_subcommand("play", "Send what a log has, when it says")),
      speed_(option(*app_, "--speed", speed_text_, "X|max", "Times the log's own (default 1)")),
      gap_(option(*app_, "--gap", gap_text_, "MS", "Cut longer pauses to MS")),
      from_(option(*app_, "--from", from_text_, "TIME", "Begin at this time of the log, or +S")),
      to_(option(*app_, "--to", to_text_, "TIME", "End after it; +S: since the first frame")) {
  prepare(*app_, "play [OPTIONS] FILE BUS|BUS=NAME...", examples);
  without_type(app_->add_option("FILE", file_, "A log, or -: from standard input"));
  without_type(app_->add_option("BUS", buses_, "can0, local:NAME or serial:DEVICE"));
  loop_ = app_->add_flag("--loop{0}", loop_text_, "Again and again, or N times")->type_name("N");
  option(*app_, "--timeout", timeout_text_, "MS",
         "Longest wait of a frame for the bus (default 1000)");
  wait_ = app_->add_flag("--wait{10000}", wait_text_, "Wait until somebody listens on a local bus")
              ->type_name("MS");
}

PlayPace PlayWords::parse_pace() const {
  PlayPace pace;
  if (speed_->count() > 0) {
    pace.speed = speed_text_ == "max" ? std::nullopt : std::optional(parse_speed(speed_text_));
  }
  if (gap_->count() > 0) {
    pace.longest_pause = parse_ms("--gap", gap_text_, 0);
  }
  return pace;
}

PlayOptions PlayWords::parse_options() const {
  constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
  PlayOptions options;
  options.pace = parse_pace();
  if (from_->count() > 0) {
    options.from = parse_time("--from", from_text_);
  }
  if (to_->count() > 0) {
    options.to = parse_time("--to", to_text_);
  }
  if (loop_->count() > 0) {
    options.times = parse_number("--loop", loop_text_, 0, most);
  }
  options.timeout = parse_ms("--timeout", timeout_text_, 1);
  if (wait_->count() > 0) {
    options.wait = parse_ms("--wait", wait_text_, 1);
  }
  return options;
}

PlayOptions PlayWords::parse() const {
  refuse_rest(*app_, "play");
  PlayOptions options = parse_options();
  if (file_.empty()) {
    refuse("play", "expected FILE and BUS");
  }
  if (buses_.empty()) {
    refuse("play", "expected BUS after FILE, or BUS=NAME for an interface of the log");
  }
  options.file = file_;
  options.routes = value_or_refuse(parse_routes(buses_));
  for (const std::string& bus : options.routes.buses) {
    if (options.wait && parse_bus_url(bus)->kind != BusUrl::Kind::local) {
      throw UsageError("--wait: expected with local:NAME alone; on " + bus +
                       " nobody can tell who listens");
    }
  }
  return options;
}

}  // namespace roio::cli
