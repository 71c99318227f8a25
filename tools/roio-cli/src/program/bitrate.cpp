#include "program/bitrate.hpp"

#include <roio/bridge.hpp>
#include <roio/bus_list.hpp>
#include <roio/text.hpp>
#include <system_error>

namespace roio::cli {

BitrateSource::BitrateSource(Bus& bus, const std::string& url, std::optional<std::uint32_t> told)
    : bus_(bus), known_(told) {
  const auto parsed = parse_bus_url(url);
  if (!known_ && parsed && parsed->kind == BusUrl::Kind::local) {
    known_ = parsed->bitrate;
  }
  if (!known_ && parsed && parsed->kind == BusUrl::Kind::socketcan) {
    interface_ = parsed->target;
  }
}

std::optional<std::uint32_t> BitrateSource::bps() {
  if (known_) {
    return known_;
  }
  if (const Bridge* const bridge = bridge_of(bus_)) {
    const BridgeInfo info = bridge->info();
    const std::uint32_t bps = info.real_bitrate_bps != 0 ? info.real_bitrate_bps : info.bitrate_bps;
    return bps != 0 ? std::optional(bps) : std::nullopt;
  }
  if (!interface_.empty() && asked_in_ != bus_.state()) {
    asked_in_ = bus_.state();
    ask_kernel();
  }
  return told_by_kernel_;
}

void BitrateSource::ask_kernel() {
  told_by_kernel_.reset();
  try {
    for (const CanInterface& interface : can_interfaces()) {
      if (interface.name == interface_) {
        told_by_kernel_ = interface.bitrate_bps;
      }
    }
  } catch (const std::system_error&) {
    // Then it is not known.
  }
}

}  // namespace roio::cli
