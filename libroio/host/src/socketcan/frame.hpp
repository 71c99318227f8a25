#ifndef ROIO_SOCKETCAN_FRAME_HPP
#define ROIO_SOCKETCAN_FRAME_HPP

#include <linux/can.h>

#include <algorithm>
#include <cstdint>
#include <roio/frame.hpp>

namespace roio::socketcan {

/// A frame as the kernel takes it.
/// @param frame valid.
inline can_frame to_kernel(const Frame& frame) noexcept {
  can_frame raw{};
  raw.can_id = tagged_id(frame);
  raw.can_dlc = frame.length;
  if (!is_remote(frame.kind)) {
    std::copy_n(frame.data, frame.length, raw.data);
  }
  return raw;
}

/// A frame of the kernel's; whatever it holds, the result is_valid().
inline Frame from_kernel(const can_frame& raw) noexcept {
  Frame frame{};
  if ((raw.can_id & CAN_ERR_FLAG) != 0) {
    frame.kind = FrameKind::error;
  } else {
    frame.kind = static_cast<FrameKind>(raw.can_id >> 29);
  }
  frame.id = raw.can_id & max_id(frame.kind);
  frame.length = std::min<std::uint8_t>(raw.can_dlc, max_data_length);
  if (!is_remote(frame.kind)) {
    std::copy_n(raw.data, frame.length, frame.data);
  }
  return frame;
}

}  // namespace roio::socketcan

#endif
