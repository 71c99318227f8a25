#include "listen/words.hpp"

#include <limits>

#include "listen/bus_words.hpp"
#include "names/filter_names.hpp"
#include "names/robot.hpp"
#include "program/one_bus.hpp"
#include "program/words.hpp"

namespace roio::cli {
namespace {

void refuse_again(const std::string& bus, std::span<const std::string> before) {
  if (const std::string* first = find_bus(before, bus)) {
    throw UsageError(*first == bus ? "BUS " + quote(bus) + ": given twice; expected once"
                                   : "BUS " + quote(bus) + ": the same as " + quote(*first) +
                                         "; expected once");
  }
}

}  // namespace

ListenWords::ListenWords(CLI::App& app)
    : app_(app),
      robot_(app),
      count_(option(app, "-n", count_text_, "N", "End after N frames")),
      quiet_(option(app, "-T", quiet_text_, "MS",
                    "End after MS without a frame (1 if -n not reached)")),
      no_foreign_(flag(app, "--no-foreign", "Leave out what is no Roio message (11-bit, remote)")),
      errors_(flag(app, "--errors", "The controller's error reports too")) {
  app.add_option("-b", named_, "A bus, whatever its name; may be given several times")
      ->type_name("BUS")
      ->allow_extra_args(false);
  without_type(app.add_option("BUS", bus_, "can0, local:NAME or serial:DEVICE; one or more"));
  without_type(app.add_option("FILTER", rest_, "Which frames; see below"));
}

ListenOptions ListenWords::parse_options() const {
  ListenOptions options;
  options.robot = robot_.find();
  if (count_->count() > 0) {
    options.count = parse_number("-n", count_text_, 1, std::numeric_limits<std::uint32_t>::max());
  }
  if (quiet_->count() > 0) {
    options.quiet_time = parse_ms("-T", quiet_text_, 1);
  }
  options.no_foreign = no_foreign_->count() > 0;
  options.errors = errors_->count() > 0;
  return options;
}

// Where the robot names a bus, and no word is one, that is meant.
std::vector<std::string> ListenWords::buses_named(const ListenOptions& options,
                                                  std::span<const std::string> words) const {
  const bool is_meant = options.robot && !options.robot->bus.empty() && named_.empty() &&
                        (words.empty() || looks_like_filter(words.front()));
  return is_meant ? std::vector{bus_of(*options.robot)} : named_;
}

void ListenWords::parse_words(ListenOptions& options) const {
  std::vector<std::string> words;
  if (!bus_.empty()) {
    words.push_back(bus_);
  }
  words.insert(words.end(), rest_.begin(), rest_.end());
  BusWords split = split_bus_words(buses_named(options, words), words);
  if (split.buses.empty()) {
    refuse(app_.get_name(), "expected BUS");
  }
  for (std::size_t i = 0; i < split.buses.size(); ++i) {
    static_cast<void>(parse_bus(split.buses[i]));
    refuse_again(split.buses[i], std::span(split.buses).first(i));
  }
  options.buses = std::move(split.buses);
  options.filters = with_addresses(options.robot.get(), std::move(split.filters));
}

}  // namespace roio::cli
