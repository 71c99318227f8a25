#include <roio/bus.hpp>
#include <roio/error.hpp>
#include <roio/text.hpp>
#include <string>

#include "local/bus.hpp"
#include "serial/bus.hpp"
#include "socketcan/bus.hpp"

namespace roio {

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
  switch (parsed->kind) {
    case BusUrl::Kind::socketcan:
      return open_socketcan(parsed->target, options);
    case BusUrl::Kind::local:
      return open_local(parsed->target, parsed->bitrate, options);
    case BusUrl::Kind::serial:
      return open_serial(*parsed, options);
  }
  throw std::system_error(Errc::not_supported, std::string(url));
}

}  // namespace roio
