#include "program/words.hpp"

#include <algorithm>
#include <charconv>
#include <memory>
#include <utility>
#include <vector>

#include "program/bitrate.hpp"

namespace roio::cli {
namespace {

/// CLI11's help, but for the first line, in which it would name every option's type.
class HelpFormatter final : public CLI::Formatter {
 public:
  explicit HelpFormatter(std::string usage) : usage_(std::move(usage)) { column_width(24); }
  std::string make_usage(const CLI::App* /*app*/, std::string /*name*/) const override {
    return "Usage: roio-cli " + usage_ + '\n';
  }
  // A flag that may have a value: CLI11 shows its default in braces, and the value's name after it.
  std::string make_option_name(const CLI::Option* option, bool is_positional) const override {
    const std::string name = Formatter::make_option_name(option, is_positional);
    const std::size_t brace = name.find('{');
    return brace == std::string::npos
               ? name
               : name.substr(0, brace) + "[=" + option->get_type_name() + "]";
  }
  std::string make_option_opts(const CLI::Option* option) const override {
    const bool is_flag = option->get_items_expected_min() == 0;
    return is_flag ? "" : Formatter::make_option_opts(option);
  }

 private:
  std::string usage_;
};

}  // namespace

void refuse(const std::string& command, const std::string& what) {
  const std::string name = command.empty() ? "roio-cli" : "roio-cli " + command;
  throw UsageError(what + "; `" + name + " --help` shows how");
}

void refuse_rest(const CLI::App& app, const std::string& command, const char* commands) {
  std::vector<std::string> rest = app.remaining();
  // What says that no option follows is taken, and is no word itself.
  rest.erase(rest.begin(), std::find_if(rest.begin(), rest.end(),
                                        [](const std::string& word) { return word != "--"; }));
  if (rest.empty()) {
    return;
  }
  if (rest.front().starts_with('-')) {
    refuse(command, "unknown option " + quote(rest.front()));
  }
  if (commands == nullptr) {
    refuse(command, "expected no more words, found " + quote(rest.front()));
  }
  refuse(command, "unknown command " + quote(rest.front()) + ": expected " + commands);
}

std::uint64_t parse_number(const std::string& option, const std::string& text,
                           std::uint64_t smallest, std::uint64_t largest) {
  std::uint64_t value = 0;
  const char* last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  if (error != std::errc() || end != last || value < smallest || value > largest) {
    throw UsageError(option + ": expected a whole number " + std::to_string(smallest) + ".." +
                     std::to_string(largest) + ", found " + quote(text));
  }
  return value;
}

std::chrono::milliseconds parse_ms(const std::string& option, const std::string& text,
                                   std::uint64_t smallest) {
  constexpr std::uint64_t longest_ms = 24ULL * 60 * 60 * 1000;
  return std::chrono::milliseconds(parse_number(option, text, smallest, longest_ms));
}

std::uint32_t parse_bitrate(const std::string& text) {
  return static_cast<std::uint32_t>(
      parse_number("--bitrate", text, slowest_bitrate_bps, fastest_bitrate_bps));
}

std::string parse_bus(const std::string& text) {
  static_cast<void>(value_or_refuse(parse_bus_url(text)));
  return text;
}

CLI::Option* without_type(CLI::Option* option) {
  return option->type_name("");
}

CLI::Option* flag(CLI::App& app, const char* name, const char* description) {
  return app.add_flag(name)->description(description)->disable_flag_override();
}

CLI::Option* option(CLI::App& app, const char* name, std::string& text, const char* value,
                    const char* description) {
  return app.add_option(name, text, description)->type_name(value);
}

void prepare(CLI::App& app, const char* usage, const char* examples) {
  app.allow_extras();
  app.footer(examples);
  app.formatter(std::make_shared<HelpFormatter>(usage));
  app.set_help_flag("-h,--help", "Print this help and end");
}

}  // namespace roio::cli
