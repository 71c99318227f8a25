#include <array>
#include <roio/candump_log.hpp>

#include "frames.hpp"
#include "target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roio;
  const std::string_view text = fuzz::as_text(data, size);
  const auto line = parse_log_line(text);
  if (!line) {
    fuzz::require_good_error(line.error(), text);
    return 0;
  }
  fuzz::require(is_valid(line->frame), "a frame read is one that a bus carries");
  std::array<char, max_log_line> buffer{};
  const std::size_t length = format_log_line(buffer, line->time, line->interface_name, line->frame);
  fuzz::require(length <= buffer.size(), "a line fits");
  const auto again = parse_log_line({buffer.data(), length});
  fuzz::require(again && again->interface_name == line->interface_name &&
                    fuzz::same(again->frame, line->frame),
                "a line comes back");
  fuzz::require(again->time == std::chrono::floor<std::chrono::microseconds>(line->time),
                "its time comes back to the microsecond");
  return 0;
}
