/// OwnNode: the bridge as a node of the network: it answers who asks for its counters.
/// Source: docs/protocol.md "System messages".
#ifndef ROIO_BRIDGE_OWN_NODE_H
#define ROIO_BRIDGE_OWN_NODE_H

#include "can_side.h"
#include "config.h"
#include "tally.h"

namespace roio {
namespace bridge {

class OwnNode {
 public:
  explicit OwnNode(Tally& tally, CanSide& can) : tally_(tally), can_(can), own_(default_address) {}

  Address address() const { return own_; }
  /// @param address node 255: none. @return ok or bad_argument.
  Status set_address(Address address) {
    if (address.subnet > max_subnet) {
      return Status::bad_argument;
    }
    own_ = address;
    return Status::ok;
  }

  /// Looks at what has come, and answers if it is for this node.
  void take(const Mcp2515Frame& frame) {
    // Most is for others: that has to show at the first byte.
    if ((frame.bytes[0] & (mcp2515::class_bits | max_subnet)) != (system_class | own_.subnet) ||
        own_.node == broadcast_node) {
      return;
    }
    Message message;
    if (to_message(mcp2515::from_chip(frame), message) == Status::ok &&
        message.header.destination == own_ && message.length == 2 &&
        message.data[0] == counter_request && message.data[1] < serial::counter_count) {
      answer(message);
    }
  }

 private:
  static constexpr uint8_t system_class = static_cast<uint8_t>(MessageClass::system) << 5;
  static constexpr uint8_t counter_request = 0x01;
  static constexpr uint8_t counter_answer = 0x81;

  void answer(const Message& request) {
    const uint32_t value = tally_.value(request.data[1]);
    const Message message = {
        {request.header.priority, MessageClass::system, request.header.source, own_},
        6,
        {counter_answer, request.data[1], static_cast<uint8_t>(value >> 24),
         static_cast<uint8_t>(value >> 16), static_cast<uint8_t>(value >> 8),
         static_cast<uint8_t>(value)}};
    Frame frame;
    if (to_frame(message, frame) == Status::ok && can_.send_own(frame) != Status::ok) {
      // No room: whoever asked gets no answer, and asks again.
    }
  }

  Tally& tally_;
  CanSide& can_;
  Address own_;
};

}  // namespace bridge
}  // namespace roio

#endif
