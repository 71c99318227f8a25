#include <array>
#include <roio/candump_log.hpp>

#include "frames.hpp"
#include "target.hpp"

namespace roio::fuzz {

void check(std::string_view text) {
  const auto line = parse_log_line(text);
  if (!line) {
    require_good_error(line.error(), text);
    return;
  }
  require(is_valid(line->frame), "a frame read is one that a bus carries");
  std::array<char, max_log_line> buffer{};
  const std::size_t length = format_log_line(buffer, line->time, line->interface_name, line->frame);
  require(length <= buffer.size(), "a line fits");
  const auto again = parse_log_line({buffer.data(), length});
  require(again && again->interface_name == line->interface_name && same(again->frame, line->frame),
          "a line comes back");
  require(again->time == std::chrono::floor<std::chrono::microseconds>(line->time),
          "its time comes back to the microsecond");
}

}  // namespace roio::fuzz
