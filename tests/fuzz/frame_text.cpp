#include <roio/candump_log.hpp>

#include "frames.hpp"
#include "target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roio;
  const std::string_view text = fuzz::as_text(data, size);
  const auto frame = parse_frame_text(text);
  if (!frame) {
    fuzz::require_good_error(frame.error(), text);
    return 0;
  }
  fuzz::require(is_valid(*frame), "a frame read is one that a bus carries");
  const auto again = parse_frame_text(to_text(*frame));
  fuzz::require(again && fuzz::same(*again, *frame), "a frame comes back");
  return 0;
}
