// In a build without roio::robot: no names.
#include <cstdlib>

#include "names/fields_text.hpp"
#include "names/message_words.hpp"
#include "names/robot.hpp"
#include "program/exit_status.hpp"

namespace roio::cli {

std::shared_ptr<const Robot> find_robot(const std::optional<std::string>& option) {
  const char* const variable = std::getenv("ROIO_ROBOT");
  const bool is_named = option ? !option->empty() : variable != nullptr && *variable != '\0';
  if (is_named) {
    throw UsageError("--robot: this roio-cli was built without JSON (ROIO_BUILD_JSON)");
  }
  return nullptr;
}

std::string bus_of(const Robot& /*robot*/) {
  return {};
}

Parsed<std::optional<Bytes>> parse_message_words(const Robot& /*robot*/, Address /*source*/,
                                                 Address /*destination*/,
                                                 std::span<const std::string> /*words*/) {
  return std::optional<Bytes>();
}

void append_fields(Buffer& /*out*/, const NamedMessage& /*message*/) {}

}  // namespace roio::cli
