/// ArduinoMessage: a message as a sketch has it: Roio::Message. It is kept as the chip has it, so
/// what a sketch does not ask for is never computed, and a message that is passed on is not copied.
#ifndef ROIO_ARDUINO_MESSAGE_HPP
#define ROIO_ARDUINO_MESSAGE_HPP

#include <roio/mcp2515_frame.hpp>

namespace roio {

class ArduinoMessage {
 public:
  /// For receive() to fill; empty, to 0.0.
  constexpr ArduinoMessage() : frame_() {}

  /// To be sent. A message that is not as the limits below have it is refused by send().
  /// @param destination subnet 0..31; node 255 is everybody there.
  /// @param data copied. @param length 0..8.
  ArduinoMessage(Address destination, const uint8_t* data, uint8_t length,
                 Priority priority = Priority::normal)
      : frame_() {
    setDestination(destination);
    setPriority(priority);
    setLength(length);
    for (uint8_t i = 0; i < length && i < max_data_length; ++i) {
      frame_.data()[i] = data[i];
    }
  }

  Address source() const { return mcp2515::source_of(frame_); }
  Address destination() const { return mcp2515::destination_of(frame_); }
  bool isBroadcast() const { return is_broadcast(destination()); }
  Priority priority() const { return mcp2515::priority_of(frame_); }
  bool isUrgent() const { return priority() == Priority::urgent; }
  /// 0..8.
  uint8_t length() const { return frame_.length(); }
  const uint8_t* data() const { return frame_.data(); }
  uint8_t* data() { return frame_.data(); }
  /// @param index below length().
  uint8_t operator[](uint8_t index) const { return frame_.data()[index]; }

  void setDestination(Address destination) { mcp2515::put_destination(destination, frame_); }
  void setPriority(Priority priority) {
    frame_.bytes[0] =
        static_cast<uint8_t>((frame_.bytes[0] & 0x7FU) | (static_cast<uint8_t>(priority) << 7));
  }
  void setLength(uint8_t length) { frame_.bytes[4] = length; }

  /// The same in the chip's bytes, for the node.
  Mcp2515Frame& frame() { return frame_; }

 private:
  Mcp2515Frame frame_;
};

}  // namespace roio

#endif
