#include <roio/candump_log.hpp>

#include "frames.hpp"
#include "target.hpp"

namespace roio::fuzz {

void check(std::string_view text) {
  const auto frame = parse_frame_text(text);
  if (!frame) {
    require_good_error(frame.error(), text);
    return;
  }
  require(is_valid(*frame), "a frame read is one that a bus carries");
  const auto again = parse_frame_text(to_text(*frame));
  require(again && same(*again, *frame), "a frame comes back");
}

}  // namespace roio::fuzz
