#include "serial/settings.hpp"

#include <utility>

namespace roio {

SerialSettings settings_of(const BusUrl& url, const OpenOptions& options,
                           std::vector<serial::Rule> rules) {
  SerialSettings settings;
  settings.lifetime = options.lifetime;
  settings.in_order = options.in_order;
  settings.line_rate_bps = url.baud.value_or(settings.line_rate_bps);
  settings.bitrate_bps = url.bitrate;
  settings.mode = url.mode;
  settings.rules = std::move(rules);
  return settings;
}

}  // namespace roio
