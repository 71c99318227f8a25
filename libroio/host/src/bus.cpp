#include <optional>
#include <roio/bus.hpp>
#include <roio/error.hpp>
#include <roio/text.hpp>
#include <string>
#include <system_error>

#include "local/bus.hpp"
#include "parts/fork.hpp"
#include "serial/bus.hpp"
#include "socketcan/bus.hpp"

namespace roio {
namespace {

/// What was meant by a name that no CAN interface has: as a word of its own, a local bus and a
/// serial port are written without their kind soon enough. None: an interface was meant.
std::optional<std::string> other_bus(const std::string& name) {
  if (name.find("can") != std::string::npos) {
    return std::nullopt;
  }
  if (name == "serial" || name == "auto") {
    return "serial:auto";
  }
  if (name.starts_with("tty")) {
    return "serial:/dev/" + name;
  }
  const std::string local = "local:" + (name == "local" ? "robot" : name);
  return parse_bus_url(local) ? std::optional(local) : std::nullopt;
}

std::unique_ptr<Bus> open_interface(const std::string& name, const OpenOptions& options) {
  try {
    return open_socketcan(name, options);
  } catch (const std::system_error& error) {
    const bool is_there =
        error.code() != Errc::no_such_interface && error.code() != Errc::no_can_support;
    const auto meant = is_there ? std::nullopt : other_bus(name);
    if (!meant) {
      throw;
    }
    throw std::system_error(error.code(), name + " (did you mean " + *meant + "?)");
  }
}

std::unique_ptr<Bus> open(const BusUrl& url, const OpenOptions& options) {
  switch (url.kind) {
    case BusUrl::Kind::local:
      return open_local(url.target, url.bitrate, options);
    case BusUrl::Kind::serial:
      return open_serial(url, options);
    case BusUrl::Kind::socketcan:
      break;
  }
  return open_interface(url.target, options);
}

}  // namespace

const char* to_string(Result result) noexcept {
  switch (result) {
    case Result::ok:
      return "ok";
    case Result::timeout:
      return "timeout";
    case Result::cancelled:
      return "cancelled";
    case Result::closed:
      return "closed";
  }
  return "unknown result";
}

const char* to_string(BusState state) noexcept {
  switch (state) {
    case BusState::active:
      return "error-active";
    case BusState::warning:
      return "error-warning";
    case BusState::passive:
      return "error-passive";
    case BusState::bus_off:
      return "bus-off";
    case BusState::down:
      return "down";
    case BusState::absent:
      return "absent";
  }
  return "unknown state";
}

std::unique_ptr<Bus> open(std::string_view url, const OpenOptions& options) {
  const Parsed<BusUrl> parsed = parse_bus_url(url);
  if (!parsed) {
    throw std::system_error(Errc::bad_url, parsed.error().message);
  }
  return parents_bus(open(*parsed, options));
}

}  // namespace roio
