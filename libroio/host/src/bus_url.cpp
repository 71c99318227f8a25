#include <algorithm>
#include <roio/text.hpp>

#include "decimal.hpp"
#include "quote.hpp"

namespace roio {
namespace {

constexpr std::size_t max_interface_name = 15;  // the kernel's IFNAMSIZ, less the zero at its end
constexpr std::size_t max_local_name = 64;
constexpr std::uint32_t min_bitrate_bps = 1000;
constexpr std::uint32_t max_bitrate_bps = 1000000;

// A part of the URL that knows where it stands in it, so that errors can say so.
struct Part {
  std::string_view text;
  std::size_t offset;

  [[nodiscard]] Part from(std::size_t at) const { return {text.substr(at), offset + at}; }
  [[nodiscard]] Part to(std::size_t at) const { return {text.substr(0, at), offset}; }
};

struct TargetAndOptions {
  Part target;
  std::optional<Part> options;
};

TargetAndOptions split_options(Part part) {
  const std::size_t mark = part.text.find('?');
  if (mark == std::string_view::npos) {
    return {part, std::nullopt};
  }
  return {part.to(mark), part.from(mark + 1)};
}

// White space and control characters are no part of a name (a zero would even end it).
bool is_interface_character(char character) {
  const auto byte = static_cast<unsigned char>(character);
  return byte > ' ' && byte != 0x7F && character != '/' && character != ':';
}

Parsed<BusUrl> read_socketcan(Part part) {
  const auto [target, options] = split_options(part);
  const std::string_view name = target.text;
  if (name.empty() || name.size() > max_interface_name) {
    return ParseError{"an interface name of " + std::to_string(name.size()) +
                          " bytes; expected 1..15, such as can0",
                      target.offset};
  }
  const auto bad = std::find_if_not(name.begin(), name.end(), is_interface_character);
  if (bad != name.end()) {
    const auto at = static_cast<std::size_t>(bad - name.begin());
    return ParseError{quote(name.substr(at, 1)) + " is not allowed in an interface name",
                      target.offset + at};
  }
  if (name == "." || name == "..") {
    return ParseError{"not an interface name; expected one such as can0", target.offset};
  }
  if (options) {
    return ParseError{
        "an interface takes no options here; `ip link set` sets its bit rate and the rest",
        options->offset - 1};
  }
  return BusUrl{BusUrl::Kind::socketcan, std::string(name), std::nullopt};
}

bool is_local_character(char character) {
  return is_digit(character) || (character >= 'a' && character <= 'z') ||
         (character >= 'A' && character <= 'Z') || character == '.' || character == '_' ||
         character == '-';
}

std::optional<ParseError> check_local_name(Part part) {
  const std::string_view name = part.text;
  if (name.empty() || name.size() > max_local_name) {
    return ParseError{
        "a bus name of " + std::to_string(name.size()) + " bytes; expected 1..64, such as robot",
        part.offset};
  }
  const auto bad = std::find_if_not(name.begin(), name.end(), is_local_character);
  if (bad != name.end()) {
    const auto at = static_cast<std::size_t>(bad - name.begin());
    return ParseError{quote(name.substr(at, 1)) +
                          " is not allowed in a bus name; expected letters, digits, '.', '_', '-'",
                      part.offset + at};
  }
  if (name[0] == '.') {
    return ParseError{"a bus name must not start with a dot", part.offset};
  }
  return std::nullopt;
}

std::optional<ParseError> read_local_option(Part option, BusUrl& url) {
  const std::size_t equals = option.text.find('=');
  const std::string_view name = option.text.substr(0, equals);
  if (name != "bitrate") {
    return ParseError{
        (name.empty() ? "an option without a name" : "unknown option " + quote(name)) +
            "; expected bitrate=BPS",
        option.offset};
  }
  if (url.bitrate) {
    return ParseError{"option bitrate is given twice", option.offset};
  }
  if (equals == std::string_view::npos) {
    return ParseError{"option bitrate has no value; expected bitrate=BPS", option.offset};
  }
  const Part value = option.from(equals + 1);
  const auto bitrate_bps = read_decimal(value.text);
  if (!bitrate_bps || *bitrate_bps < min_bitrate_bps || *bitrate_bps > max_bitrate_bps) {
    return ParseError{
        "bitrate " + quote(value.text) + "; expected 1000..1000000 (bit/s), without leading zeros",
        value.offset};
  }
  url.bitrate = bitrate_bps;
  return std::nullopt;
}

Parsed<BusUrl> read_local(Part part) {
  auto [target, options] = split_options(part);
  if (auto error = check_local_name(target)) {
    return *error;
  }
  BusUrl url{BusUrl::Kind::local, std::string(target.text), std::nullopt};
  while (options) {
    const std::size_t end = std::min(options->text.find('&'), options->text.size());
    if (auto error = read_local_option(options->to(end), url)) {
      return *error;
    }
    options = end < options->text.size() ? std::optional(options->from(end + 1)) : std::nullopt;
  }
  return url;
}

// No bus of this kind can be opened yet, so its options are not looked at.
Parsed<BusUrl> read_serial(Part part) {
  const Part device = split_options(part).target;
  if (device.text.empty()) {
    return ParseError{"no device; expected one such as /dev/ttyACM0", device.offset};
  }
  return BusUrl{BusUrl::Kind::serial, std::string(device.text), std::nullopt};
}

Parsed<BusUrl> read_bus_url(Part url) {
  constexpr const char* expected = "; expected an interface such as can0, or local:NAME";
  if (url.text.empty()) {
    return ParseError{std::string("empty") + expected, 0};
  }
  const std::size_t colon = url.text.find(':');
  // A colon past '?' belongs to an option.
  if (colon == std::string_view::npos || colon > url.text.find('?')) {
    return read_socketcan(url);
  }
  const std::string_view kind = url.text.substr(0, colon);
  const Part rest = url.from(colon + 1);
  if (kind == "socketcan") {
    return read_socketcan(rest);
  }
  if (kind == "local") {
    return read_local(rest);
  }
  if (kind == "serial") {
    return read_serial(rest);
  }
  return ParseError{"unknown kind of bus " + quote(kind) + expected, 0};
}

}  // namespace

Parsed<BusUrl> parse_bus_url(std::string_view text) {
  return in_context("bus", text, read_bus_url({text, 0}));
}

}  // namespace roio
