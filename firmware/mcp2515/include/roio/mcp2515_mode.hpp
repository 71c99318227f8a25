/// Mcp2515, changing modes, and what goes with sleep. Included by mcp2515.hpp.
///
/// Asleep the chip's oscillator stands still. What wakes it is WAKIF, with WAKIE set: the next
/// dominant bit on the bus sets it, or software does. Then the oscillator starts, and 128 clocks
/// later the chip only listens, until it is told to do more. What the bus carries up to then is
/// lost, the frame that woke it in any case; what comes next is received, and not acknowledged.
/// Source: MCP2515 datasheet DS20001801, 8.1 and 10.2.
#ifndef ROIO_MCP2515_MODE_HPP
#define ROIO_MCP2515_MODE_HPP

#include <roio/mcp2515.hpp>

namespace roio {

ROIO_MCP2515_MEMBER(Status)::change_mode(mcp2515::Mode mode) {
  using mcp2515::Control;
  using mcp2515::Mode;
  const Mode before = Control::mode_of(control_);
  if (!running() && !mcp2515::is_rest(before)) {
    return Status::no_chip;
  }
  status_ |= QuickStatus::txif;  // unless it has forgotten meanwhile what begin() told it
  if (before == Mode::asleep) {
    end_sleep();
  }
  if (running()) {
    look();
  }
  if (!running()) {
    control_ = 0;
    return Status::no_chip;
  }
  if (mcp2515::is_rest(mode) && (requested() != 0 || !tx_queue().empty())) {
    return Status::full;
  }
  const uint8_t control = Control::with_mode(control_, mode);
  if (mode == Mode::asleep) {
    prepare_sleep();
  }
  write_register(Register::canctrl, control);
  if (mode == Mode::asleep ? !sleeps_or_slept() : !await(mode)) {
    stop();
    return Status::wrong_mode;
  }
  control_ = control;
  if (mcp2515::is_rest(mode)) {
    status_ &= static_cast<uint8_t>(~QuickStatus::txif);
  }
  return Status::ok;
}

ROIO_MCP2515_MEMBER(bool)::await(mcp2515::Mode mode) {
  bool is_there = false;
  for (uint8_t left = mcp2515::pauses; !is_there && left != 0; --left) {
    port().pause(mcp2515::pause_us);
    is_there = mcp2515::Control::mode_of(read_register(Register::canstat)) == mode;
  }
  return is_there;
}

/// WAKIE, so that the bus can wake it; and WAKIF is to tell of what comes from now on.
ROIO_MCP2515_MEMBER(void)::prepare_sleep() {
  using mcp2515::Interrupt;
  modify_register(Register::canintf, Interrupt::wake_up, 0);
  modify_register(Register::caninte, Interrupt::wake_up, Interrupt::wake_up);
}

/// Waits until it sleeps; the bus may have woken it before anybody looks.
ROIO_MCP2515_MEMBER(bool)::sleeps_or_slept() {
  bool slept = false;
  for (uint8_t left = mcp2515::pauses; !slept && left != 0; --left) {
    port().pause(mcp2515::pause_us);
    slept = is_asleep() || (read_register(Register::canintf) & mcp2515::Interrupt::wake_up) != 0;
  }
  return slept;
}

/// Has the oscillator run, unless it does already, and waits until the chip listens.
ROIO_MCP2515_MEMBER(void)::end_sleep() {
  using mcp2515::Interrupt;
  if (is_asleep()) {
    modify_register(Register::canintf, Interrupt::wake_up, Interrupt::wake_up);
  }
  if (!await(mcp2515::Mode::listen_only)) {
    lose_chip();
  }
  control_ = mcp2515::Control::with_mode(control_, mcp2515::Mode::listen_only);
  modify_register(Register::caninte, Interrupt::wake_up, 0);
  modify_register(Register::canintf, Interrupt::wake_up, 0);
}

}  // namespace roio

#endif
