/// Mcp2515, receiving: how frames come out of the chip in the order in which they were on the bus.
/// Included by mcp2515.hpp.
#ifndef ROIO_MCP2515_RECEIVE_HPP
#define ROIO_MCP2515_RECEIVE_HPP

#include <roio/mcp2515.hpp>

namespace roio {

/// Looks for a frame, unless one is known or the line says that there is none. A line that is low
/// is no frame yet: it may be stuck, or a spike.
/// @return whether READ STATUS was read.
ROIO_MCP2515_MEMBER(bool)::look_for_frame() {
  if (received() == 0 && (!line().is_on() || port().interrupt_line_is_low())) {
    look();
    return true;
  }
  return false;
}

/// Takes the older frame out of the chip. There must be one.
/// @return whether it is one for the program.
ROIO_MCP2515_MEMBER(bool)::fetch(Mcp2515Frame& frame) {
  if (!read_rx_buffer((status_ & QuickStatus::rx0) != 0, frame)) {
    return false;
  }
  const bool wanted = Traits::all_kinds || Traits::wants(frame);
  count(wanted ? counters_.received : counters_.foreign);
  return wanted;
}

/// Reads a buffer, which frees it, and looks what has come meanwhile.
///
/// The order of two full buffers is in no register; it follows from what was seen when. RXB0 is
/// filled first, RXB1 only while RXB0 is full. So of two full buffers RXB0 is the older one, unless
/// RXB1 was full already when RXB0 was freed. Whether it was, shows right after: a frame takes
/// longer on the bus than the look does, so at most one can have come in between, and that one went
/// to RXB0. Nothing may interrupt the two. The look also tells that the chip was there all the
/// while, and it is the next call's first.
/// With an interrupt line: one that is high after the buffer was freed tells that nothing more is
/// there, and spares the look. A buffer that is full holds the line low: if it is high before the
/// buffer is freed, either the chip was reset or fell off, which the look then shows, or the line
/// is not connected.
/// @param first RXB0, else RXB1.
/// @return false: the chip was lost meanwhile; the frame cannot be trusted.
ROIO_MCP2515_MEMBER(bool)::read_rx_buffer(bool first, Mcp2515Frame& frame) {
  const bool polls = !line().is_on();
  bool called = true;
  bool looks = true;
  uint8_t quick = 0;
  {
    Transaction transaction(port(), mcp2515::read_rx(first));
    uint8_t* const data = transaction.receive(frame.bytes, Mcp2515Frame::head_length);
    frame.limit_length();
    // Only as many as the frame has.
    if (frame.length() != 0) {
      transaction.receive(data, frame.length());
    }
    called = polls || port().interrupt_line_is_low();
    typename Port::Uninterrupted together(port());
    transaction.release();
    looks = polls || !called || port().interrupt_line_is_low();
    if (looks) {
      transaction.restart(static_cast<uint8_t>(Instruction::read_status));
      quick = transaction.exchange(0);
    }
  }
  status_ &= static_cast<uint8_t>(~QuickStatus::any_rx);
  if (looks) {
    if (first) {
      status_ |= QuickStatus::rx1;  // if it is full now, it has the older frame
    }
    // Once only: the order follows from this very look, and that the buffer was freed.
    if (take_in(quick) != 0) {
      lose_chip();
      count(counters_.discarded);
      return false;
    }
    if (!called) {
      lose_line();
    }
    if (received() != 0) {
      // Perhaps both were full for a while, and a third frame was lost: to be looked at soon.
      check_soon();
    }
  }
  return true;
}

ROIO_MCP2515_MEMBER(Status)::receive(Frame& frame) {
  Mcp2515Frame bytes;
  const Status status = receive(bytes);
  if (status == Status::ok) {
    frame = mcp2515::from_chip(bytes);
  }
  return status;
}

ROIO_MCP2515_MEMBER(Status)::receive(Mcp2515Frame& frame) {
  if (rx_queue().empty() && RxQueue > 0) {
    poll();
  }
  if (!rx_queue().empty()) {
    frame = rx_queue().front();
    rx_queue().pop();
    return Status::ok;
  }
  if (!running()) {
    return Status::no_chip;
  }
  bool is_one = false;
  if (RxQueue == 0) {
    bool looked = look_for_frame();
    // As many as the chip holds, so that frames for others keep nobody here.
    uint8_t tries = 2;
    while (received() != 0) {
      looked = true;
      is_one = fetch(frame);
      if (is_one || --tries == 0) {
        break;
      }
    }
    // Without a line it has looked by now, in one way or the other.
    tend(looked || !Port::has_interrupt_line);
  }
  return is_one ? Status::ok : running() ? Status::empty : Status::no_chip;
}

ROIO_MCP2515_MEMBER(Status)::poll() {
  if (!running()) {
    return Status::no_chip;
  }
  bool looked = !rx_queue().full() && look_for_frame();
  for (uint8_t i = 0; i < RxQueue + 2U && !rx_queue().full() && received() != 0; ++i) {
    if (fetch(rx_queue().next())) {
      rx_queue().commit();
    }
    looked = true;
  }
  tend(looked);
  return running() ? Status::ok : Status::no_chip;
}

}  // namespace roio

#endif
