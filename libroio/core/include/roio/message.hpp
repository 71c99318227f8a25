/// Message: a header and 0..8 bytes, and the way from and to a CAN frame.
/// Source: docs/protocol.md "Frames".
#ifndef ROIO_MESSAGE_HPP
#define ROIO_MESSAGE_HPP

#include <stdint.h>

#include <roio/frame.hpp>
#include <roio/header.hpp>
#include <roio/status.hpp>

namespace roio {

struct Message {
  Header header;
  uint8_t length;  ///< 0..8; 0 carries no data and is still a message.
  uint8_t data[max_data_length];
};

/// Puts a message into an extended data frame.
/// @param frame written on success only; its data past length are 0.
/// @return ok; bad_argument when a header field is out of range or length > 8.
ROIO_NODISCARD inline Status to_frame(const Message& message, Frame& frame) {
  if (!is_valid(message.header) || message.length > max_data_length) {
    return Status::bad_argument;
  }
  frame.id = pack_id(message.header);
  frame.kind = FrameKind::extended;
  frame.length = message.length;
  for (uint8_t i = 0; i < max_data_length; ++i) {
    frame.data[i] = i < message.length ? message.data[i] : 0U;
  }
  return Status::ok;
}

/// Reads a frame from the bus as a message. A length above 8 (DLC 9..15 on the wire) counts as 8.
/// @param message written on ok only; its data past length are 0.
/// @return ok; not_roio: a standard, remote or error frame; unknown_class: the reserved class;
///         bad_argument: the source is a broadcast address, which no node can have.
ROIO_NODISCARD inline Status to_message(const Frame& frame, Message& message) {
  if (frame.kind != FrameKind::extended) {
    return Status::not_roio;
  }
  const Header header = unpack_id(frame.id);
  if (header.message_class == MessageClass::reserved) {
    return Status::unknown_class;
  }
  if (!is_valid_source(header.source)) {
    return Status::bad_argument;
  }
  message.header = header;
  message.length = frame.length <= max_data_length ? frame.length : max_data_length;
  for (uint8_t i = 0; i < max_data_length; ++i) {
    message.data[i] = i < message.length ? frame.data[i] : 0U;
  }
  return Status::ok;
}

}  // namespace roio

#endif
