/// What is told of a bridge and of the other buses: as lines for people, and as JSON objects.
#ifndef ROIO_CLI_BRIDGE_REPORT_HPP
#define ROIO_CLI_BRIDGE_REPORT_HPP

#include <cstdint>
#include <optional>
#include <roio/bridge.hpp>
#include <span>
#include <string>

#include "form/frame_text.hpp"

namespace roio::cli {

/// One counter, under the name that JSON has for it and the one that people read.
struct Count {
  const char* key;
  const char* label;
  std::uint64_t value;
};

/// Everything known of a bridge.
struct BridgeReport {
  BridgeInfo info;
  BridgeCounters board;
  BridgeLineCounters line;
};

/// One line of `roio-cli buses`. What is none does not apply, or is not known.
struct BusReport {
  std::string bus;   ///< As open() takes it.
  std::string kind;  ///< "can", "local", "serial".
  std::optional<std::string> state{};
  std::optional<std::uint32_t> bitrate_bps{};
  std::optional<std::string> interface_kind{};  ///< The kernel's word.
  std::optional<std::string> board{};
  std::optional<std::string> firmware{};
  std::optional<std::string> product{};
  std::optional<std::string> why_not{};  ///< Why it cannot be opened.
};

void append_text(Buffer& out, const BridgeReport& report);
/// In columns of which the first is so wide.
void append_text(Buffer& out, const BusReport& report, std::size_t width);

/// One line. @throws UsageError: this build knows no JSON.
void append_json(Buffer& out, const BridgeReport& report);
void append_json(Buffer& out, const BusReport& report);

}  // namespace roio::cli

#endif
