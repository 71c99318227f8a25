// In a build without roio::robot: no names.
#include <cstdlib>
#include <string>
#include <utility>

#include "names/named_data.hpp"
#include "names/robot.hpp"
#include "names/robot_labels.hpp"
#include "program/exit_status.hpp"

namespace roio::cli {

std::shared_ptr<const Robot> find_robot(const std::optional<std::string>& option) {
  const char* const variable = std::getenv("ROIO_ROBOT");
  const std::string file = option ? *option : variable != nullptr ? variable : "";
  const bool is_named = !file.empty() && file != "none";
  if (is_named) {
    throw UsageError("--robot: this roio-cli was built without JSON (ROIO_BUILD_JSON)");
  }
  return nullptr;
}

std::string bus_of(const Robot& /*robot*/) {
  return {};
}

Parsed<Address> address_of(const Robot* /*robot*/, const std::string& text) {
  return parse_address(text);
}

Parsed<std::optional<Bytes>> parse_named_data(const Robot& /*robot*/, Address /*source*/,
                                              Address /*destination*/,
                                              std::span<const std::string> /*words*/) {
  return std::optional<Bytes>();
}

std::shared_ptr<const Labels> labels_of(std::shared_ptr<const Robot> /*robot*/,
                                        bool /*bytes_only*/) {
  return {std::shared_ptr<void>(), &numeric_labels()};
}

}  // namespace roio::cli
