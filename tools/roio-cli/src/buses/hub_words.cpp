#include "buses/hub_words.hpp"

#include <roio/text.hpp>

#include "program/words.hpp"

namespace roio::cli {
namespace {

constexpr const char* examples = R"(Examples:
  roio-cli hub robot
  roio-cli hub --bitrate 500000 robot
  systemctl --user enable --now roio-hub@robot

One of the programs on a local bus carries it for all: whichever is there first,
unless this one is, which takes it over and keeps it until Ctrl-C. Then another
does, and nothing is lost.)";

constexpr std::uint64_t slowest = 1000;
constexpr std::uint64_t fastest = 1'000'000;

}  // namespace

HubWords::HubWords(CLI::App& program)
    : app_(program.add_subcommand("hub", "Carry a local bus until a signal")),
      bitrate_(option(*app_, "--bitrate", bitrate_text_, "BPS",
                      "Pace of the bus, 1000 to 1000000 bit/s (none: as fast as it goes)")) {
  prepare(*app_, "hub [OPTIONS] NAME", examples);
  without_type(app_->add_option("name", name_, "The bus: robot, or local:robot"));
}

HubOptions HubWords::parse() const {
  refuse_rest(*app_, "hub");
  if (name_.empty()) {
    refuse("hub", "expected NAME, such as robot");
  }
  std::string url = name_.starts_with("local:") ? name_ : "local:" + name_;
  if (bitrate_->count() > 0) {
    url += "?bitrate=" + std::to_string(parse_number("--bitrate", bitrate_text_, slowest, fastest));
  }
  return {parse_bus(url)};
}

}  // namespace roio::cli
