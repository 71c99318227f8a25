#ifndef ROIO_PARTS_FRAME_CHECK_HPP
#define ROIO_PARTS_FRAME_CHECK_HPP

#include <roio/export.hpp>
#include <roio/frame.hpp>
#include <span>

namespace roio {

/// What every backend asks of frames before it sends the first of them: each is_valid(), and none
/// an error report. So a bad frame in a batch sends nothing. Any thread.
/// @throws std::system_error Errc::bad_frame, naming the frame and what is wrong with it.
ROIO_EXPORT void check_sendable(std::span<const Frame> frames);

}  // namespace roio

#endif
