#include <cstddef>
#include <roio/error.hpp>
#include <roio/parts/frame_check.hpp>
#include <string>

namespace roio {
namespace {

std::string describe(const Frame& frame) {
  if (frame.length > max_data_length) {
    return "length " + std::to_string(frame.length) + ", expected 0..8";
  }
  if (frame.kind == FrameKind::error) {
    return "an error report, which only a controller makes";
  }
  return "identifier " + std::to_string(frame.id) + " or kind out of range";
}

}  // namespace

void check_sendable(std::span<const Frame> frames) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!is_valid(frames[i]) || frames[i].kind == FrameKind::error) {
      throw std::system_error(Errc::bad_frame,
                              "frame " + std::to_string(i) + ": " + describe(frames[i]));
    }
  }
}

}  // namespace roio
