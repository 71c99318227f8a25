#include "gen/words.hpp"

#include <limits>
#include <random>
#include <roio/text.hpp>
#include <utility>

#include "gen/numbered.hpp"
#include "names/robot.hpp"
#include "program/words.hpp"

namespace roio::cli {
namespace {

constexpr const char* examples = R"(Examples:
  roio-cli gen --load 80% can0                  until Ctrl-C
  roio-cli gen --rate 100 --time 5000 local:robot
  roio-cli gen --count 100000 can0              as fast as it goes
  roio-cli gen --size 4-8 --to random --seed 7 can0
  roio-cli gen --check can0                     on the other end, until Ctrl-C
  roio-cli gen --check -T 2000 can0             2 s after the last one, it ends

The messages have 4 to 8 bytes: the generator's id, a check, a running number.
Several generators at once are told apart by source and id. --check says of each
how many were received, lost, doubled and out of order; the exit status is 1
when any were, or when none came. It may start late: then it says from which
number on. What was lost after the last that came it cannot know: --count N says
how many have to come.)";

constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();

std::uint32_t any_number() {
  return std::random_device()();
}

double parse_load(std::string text) {
  if (text.ends_with('%')) {
    text.pop_back();
  }
  constexpr double percent = 100;
  return static_cast<double>(parse_number("--load", text, 1, 100)) / percent;
}

std::uint8_t parse_length(const std::string& text) {
  const std::uint64_t length = parse_number("--size", text, 0, max_data_length);
  if (length < shortest_numbered) {
    throw UsageError("--size: " + std::to_string(length) +
                     " bytes are too short for a number; expected 4..8");
  }
  return static_cast<std::uint8_t>(length);
}

/// "8", "4-8" or "random".
std::pair<std::uint8_t, std::uint8_t> parse_size(const std::string& text) {
  if (text == "random") {
    return {shortest_numbered, max_data_length};
  }
  const std::size_t dash = text.find('-');
  const std::uint8_t shortest = parse_length(text.substr(0, dash));
  const std::uint8_t longest =
      dash == std::string::npos ? shortest : parse_length(text.substr(dash + 1));
  if (longest < shortest) {
    throw UsageError("--size: expected the shorter first, found " + quote(text));
  }
  return {shortest, longest};
}

}  // namespace

GenWords::GenWords(CLI::App& program)
    : app_(program.add_subcommand("gen", "Send numbered messages, or check them")),
      robot_(*app_),
      check_(flag(*app_, "--check", "Receive them, and say what became of them")),
      load_(option(*app_, "--load", load_text_, "PERCENT", "Share of the bus: 80%")),
      rate_(option(*app_, "--rate", rate_text_, "N", "Messages a second")),
      bitrate_(option(*app_, "--bitrate", bitrate_text_, "BPS",
                      "Bit rate of a bus that does not tell, for --load")),
      size_(option(*app_, "--size", size_text_, "N|A-B", "Bytes: 4 to 8, or random (default 8)")),
      from_(option(*app_, "--from", from_text_, "ADDRESS", "Source, or random (default 0.10)")),
      to_(option(*app_, "--to", to_text_, "ADDRESS", "Destination, or random (default 30.254)")),
      urgent_(flag(*app_, "--urgent", "Ahead of normal messages")),
      id_(option(*app_, "--id", id_text_, "N", "Of this generator, 0 to 127 (default: any)")),
      seed_(option(*app_, "--seed", seed_text_, "N", "Of what is random (default: any, told)")),
      count_(option(*app_, "--count", count_text_, "N", "End after N messages")),
      time_(option(*app_, "--time", time_text_, "MS", "End after MS")),
      quiet_(option(*app_, "-T", quiet_text_, "MS", "--check: end after MS without one")),
      timeout_(option(*app_, "--timeout", timeout_text_, "MS",
                      "Longest wait of a message for the bus (default 1000)")),
      verbose_(flag(*app_, "-v,--verbose", "--check: tell on stderr when listening")) {
  prepare(*app_, "gen [OPTIONS] [BUS]", examples);
  without_type(app_->add_option("BUS", bus_, "can0, local:NAME or serial:DEVICE"));
}

std::variant<GenOptions, CheckOptions> GenWords::parse() const {
  refuse_rest(*app_, "gen");
  const auto robot = robot_.find();
  if (check_->count() > 0) {
    return parse_check(robot.get());
  }
  return parse_gen(robot.get());
}

CheckOptions GenWords::parse_check(const Robot* robot) const {
  for (const CLI::Option* option :
       {load_, rate_, bitrate_, size_, from_, to_, urgent_, id_, seed_, timeout_}) {
    if (option->count() > 0) {
      throw UsageError(option->get_name() + ": expected without --check, which takes what comes");
    }
  }
  CheckOptions options;
  if (count_->count() > 0) {
    options.count = parse_number("--count", count_text_, 1, most);
  }
  if (time_->count() > 0) {
    options.time = parse_ms("--time", time_text_, 1);
  }
  if (quiet_->count() > 0) {
    options.quiet_time = parse_ms("-T", quiet_text_, 1);
  }
  options.verbose = verbose_->count() > 0;
  options.bus = parse_bus_or_robots(robot, bus_, "gen");
  return options;
}

GenOptions GenWords::parse_gen(const Robot* robot) const {
  for (const CLI::Option* option : {quiet_, verbose_}) {
    if (option->count() > 0) {
      throw UsageError(option->get_name() + ": expected with --check alone");
    }
  }
  GenOptions options;
  options.traffic = parse_traffic(robot);
  parse_speed(options);
  if (count_->count() > 0) {
    options.count = parse_number("--count", count_text_, 1, most);
  }
  if (time_->count() > 0) {
    options.time = parse_ms("--time", time_text_, 1);
  }
  options.timeout = parse_ms("--timeout", timeout_text_, 1);
  options.bus = parse_bus_or_robots(robot, bus_, "gen");
  return options;
}

void GenWords::parse_speed(GenOptions& options) const {
  constexpr std::uint64_t fastest = 1'000'000;
  if (load_->count() > 0 && rate_->count() > 0) {
    throw UsageError("expected either --load or --rate, not both");
  }
  if (load_->count() > 0) {
    options.load = parse_load(load_text_);
  }
  if (rate_->count() > 0) {
    options.rate = parse_number("--rate", rate_text_, 1, fastest);
  }
  if (bitrate_->count() > 0) {
    options.bitrate_bps = parse_bitrate(bitrate_text_);
  }
}

TrafficOptions GenWords::parse_traffic(const Robot* robot) const {
  TrafficOptions traffic;
  if (from_text_ != "random") {
    traffic.source = parse_sender(robot, from_text_, "--from: ");
  }
  if (to_text_ != "random") {
    traffic.destination = value_or_refuse(address_of(robot, to_text_), "--to: ");
  }
  traffic.priority = urgent_->count() > 0 ? Priority::urgent : Priority::normal;
  std::tie(traffic.shortest, traffic.longest) = parse_size(size_text_);
  traffic.id =
      static_cast<std::uint8_t>(id_->count() > 0 ? parse_number("--id", id_text_, 0, max_generator)
                                                 : any_number() % (max_generator + 1U));
  traffic.seed = seed_->count() > 0
                     ? static_cast<std::uint32_t>(parse_number("--seed", seed_text_, 0, most))
                     : any_number();
  return traffic;
}

}  // namespace roio::cli
