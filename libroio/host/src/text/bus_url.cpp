#include <algorithm>
#include <array>
#include <roio/serial_protocol.hpp>
#include <roio/text.hpp>
#include <span>

#include "text/decimal.hpp"
#include "text/quote.hpp"

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
  if (name.starts_with('/')) {
    const bool is_plain = std::all_of(name.begin(), name.end(), [](char character) {
      return character > ' ' && character <= '~';
    });
    return ParseError{"a path is no interface; expected serial:" +
                          (is_plain ? std::string(name) : std::string("DEVICE")) +
                          " for the bridge on that serial port",
                      target.offset};
  }
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
  return BusUrl{BusUrl::Kind::socketcan, std::string(name)};
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

// One option of a kind of bus: its name, what stands for its value in errors, and what reads it.
struct Option {
  std::string_view name;
  const char* value;
  std::optional<ParseError> (*read)(Part value, BusUrl& url);
  bool (*is_given)(const BusUrl& url);
};

std::optional<ParseError> read_bitrate(Part value, BusUrl& url) {
  const auto bitrate_bps = read_decimal(value.text);
  if (!bitrate_bps || *bitrate_bps < min_bitrate_bps || *bitrate_bps > max_bitrate_bps) {
    return ParseError{
        "bitrate " + quote(value.text) + "; expected 1000..1000000 (bit/s), without leading zeros",
        value.offset};
  }
  url.bitrate = bitrate_bps;
  return std::nullopt;
}

std::optional<ParseError> read_baud(Part value, BusUrl& url) {
  const auto baud = read_decimal(value.text);
  for (std::uint8_t i = 0; baud && i < serial::rate_count; ++i) {
    if (serial::rate_bps(i) == *baud) {
      url.baud = baud;
      return std::nullopt;
    }
  }
  return ParseError{
      "baud " + quote(value.text) + "; expected 115200, 250000, 500000, 1000000 or 2000000",
      value.offset};
}

std::optional<ParseError> read_mode(Part value, BusUrl& url) {
  const auto mode = parse_bridge_mode(value.text);
  if (!mode) {
    return ParseError{mode.error().message, value.offset};
  }
  url.mode = *mode;
  return std::nullopt;
}

constexpr Option bitrate_option{"bitrate", "BPS", read_bitrate,
                                [](const BusUrl& url) { return url.bitrate.has_value(); }};
constexpr std::array local_options{bitrate_option};
constexpr std::array serial_options{
    Option{"baud", "RATE", read_baud, [](const BusUrl& url) { return url.baud.has_value(); }},
    bitrate_option,
    Option{"mode", "MODE", read_mode, [](const BusUrl& url) { return url.mode.has_value(); }}};

std::string form_of(const Option& option) {
  return std::string(option.name) + '=' + option.value;
}

/// "a=A", "a=A or b=B", "a=A, b=B or c=C".
std::string forms_of(std::span<const Option> known) {
  std::string forms = form_of(known.front());
  for (std::size_t i = 1; i < known.size(); ++i) {
    forms += (i + 1 == known.size() ? " or " : ", ") + form_of(known[i]);
  }
  return forms;
}

std::optional<ParseError> read_option(Part option, std::span<const Option> known, BusUrl& url) {
  const std::size_t equals = option.text.find('=');
  const std::string_view name = option.text.substr(0, equals);
  const auto found = std::find_if(known.begin(), known.end(),
                                  [name](const Option& one) { return one.name == name; });
  if (found == known.end()) {
    return ParseError{
        (name.empty() ? "an option without a name" : "unknown option " + quote(name)) +
            "; expected " + forms_of(known),
        option.offset};
  }
  if (found->is_given(url)) {
    return ParseError{"option " + std::string(name) + " is given twice", option.offset};
  }
  if (equals == std::string_view::npos) {
    return ParseError{"option " + std::string(name) + " has no value; expected " + form_of(*found),
                      option.offset};
  }
  return found->read(option.from(equals + 1), url);
}

std::optional<ParseError> read_options(std::optional<Part> options, std::span<const Option> known,
                                       BusUrl& url) {
  while (options) {
    const std::size_t end = std::min(options->text.find('&'), options->text.size());
    if (auto error = read_option(options->to(end), known, url)) {
      return error;
    }
    options = end < options->text.size() ? std::optional(options->from(end + 1)) : std::nullopt;
  }
  return std::nullopt;
}

Parsed<BusUrl> read_local(Part part) {
  const auto [target, options] = split_options(part);
  if (auto error = check_local_name(target)) {
    return *error;
  }
  BusUrl url{BusUrl::Kind::local, std::string(target.text)};
  if (auto error = read_options(options, local_options, url)) {
    return *error;
  }
  return url;
}

Parsed<BusUrl> read_serial(Part part) {
  const auto [device, options] = split_options(part);
  if (device.text.empty()) {
    return ParseError{"no device; expected one such as /dev/ttyACM0, or auto", device.offset};
  }
  if (device.text.find('\0') != std::string_view::npos) {
    return ParseError{quote(device.text.substr(device.text.find('\0'), 1)) +
                          " is not allowed in the name of a device",
                      device.offset + device.text.find('\0')};
  }
  BusUrl url{BusUrl::Kind::serial, std::string(device.text)};
  if (auto error = read_options(options, serial_options, url)) {
    return *error;
  }
  return url;
}

Parsed<BusUrl> read_bus_url(Part url) {
  constexpr const char* expected =
      "; expected an interface such as can0, local:NAME or serial:DEVICE";
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
