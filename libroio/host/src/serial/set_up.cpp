#include "serial/set_up.hpp"

#include <utility>

namespace roio::serial {
namespace {

/// None: it is so already. Saying it again would take the bridge off the bus for a moment.
std::optional<Request> request_for_bus(const SerialSettings& settings, KnownBridge& bridge) {
  const BridgeInfo& info = bridge.info();
  const std::uint32_t bitrate_bps = settings.bitrate_bps.value_or(info.bitrate_bps);
  const BridgeMode mode = settings.mode.value_or(info.mode);
  if (bitrate_bps == info.bitrate_bps && mode == info.mode) {
    return std::nullopt;
  }
  return bus_request(bridge, bitrate_bps, mode, {});
}

std::optional<Request> request_for_address(const SerialSettings& settings) {
  if (!settings.address) {
    return std::nullopt;
  }
  return Request{Down::address, {settings.address->subnet, settings.address->node}, {}};
}

std::optional<Request> request_for_rules(const SerialSettings& settings) {
  if (!settings.rules) {
    return std::nullopt;
  }
  return Request{Down::filter, filter_payload(*settings.rules), {}};
}

}  // namespace

bool SetUp::takes_line_rate() {
  if (step_ != Step::line_rate) {
    return false;
  }
  step_ = Step::bus;
  return true;
}

std::optional<Request> SetUp::next(const SerialSettings& settings, KnownBridge& bridge) {
  std::optional<Request> request;
  while (!request && step_ != Step::done) {
    switch (step_) {
      case Step::line_rate:
      case Step::bus:
        step_ = Step::address;
        request = request_for_bus(settings, bridge);
        break;
      case Step::address:
        step_ = Step::rules;
        request = request_for_address(settings);
        break;
      case Step::rules:
        step_ = Step::done;
        request = request_for_rules(settings);
        break;
      case Step::done:
        break;
    }
  }
  return request;
}

Request bus_request(KnownBridge& bridge, std::uint32_t bitrate_bps, BridgeMode mode, Done done) {
  return {Down::bus, bus_payload(bitrate_bps, mode),
          [&bridge, bitrate_bps, mode, done = std::move(done)](const Reply& reply) {
            if (reply.is_kept()) {
              bridge.set_bus(bitrate_bps, mode);
            }
            if (done) {
              done(reply);
            }
          }};
}

}  // namespace roio::serial
