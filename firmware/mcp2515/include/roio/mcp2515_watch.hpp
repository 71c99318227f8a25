/// Mcp2515, looking after the chip: its registers, what READ STATUS shows, errors on the bus, and
/// how a chip is noticed that was reset or is not there. Included by mcp2515.hpp.
#ifndef ROIO_MCP2515_WATCH_HPP
#define ROIO_MCP2515_WATCH_HPP

#include <roio/mcp2515.hpp>

namespace roio {

namespace mcp2515 {
constexpr uint8_t calls_between_checks = 64;
constexpr uint8_t calls_at_most = 192;  ///< Where there is always a frame to be read.
}  // namespace mcp2515

// --- the chip's registers ------------------------------------------------------------------------

ROIO_MCP2515_MEMBER(uint8_t)::access_register(Register address, uint8_t value,
                                              Instruction instruction) {
  RegisterAccess access(port(), instruction, address);
  return access.exchange(value);
}

ROIO_MCP2515_MEMBER(uint8_t)::read_register(Register address) {
  return access_register(address, 0, Instruction::read);
}

ROIO_MCP2515_MEMBER(void)::write_register(Register address, uint8_t value) {
  access_register(address, value, Instruction::write);
}

ROIO_MCP2515_MEMBER(void)::modify_register(Register address, uint8_t mask, uint8_t value) {
  RegisterAccess access(port(), Instruction::bit_modify, address);
  access.put(mask);
  access.put(value);
}

ROIO_MCP2515_MEMBER(void)::read_error_counters(uint8_t& transmit, uint8_t& receive) {
  transmit = read_register(Register::tec);
  receive = read_register(Register::rec);
}

/// @return the bits of the mode in which CANSTAT differs from `control`: 0 when that is its mode.
ROIO_MCP2515_MEMBER(uint8_t)::mode_differs_from(uint8_t control) {
  return (read_register(Register::canstat) ^ control) & mcp2515::Control::mode_mask;
}

// --- what READ STATUS shows ----------------------------------------------------------------------

/// The three TXnIF are set, and the chip sends nothing but what it was told to. A chip that was
/// reset, and lines stuck at 0 or 1, look different; but for one that is at 1 when all buffers are
/// in use.
/// @return the bits that cannot be so: 0 when all is well.
ROIO_MCP2515_MEMBER(uint8_t)::nonsense_in(uint8_t quick) const {
  constexpr uint8_t no_rx = static_cast<uint8_t>(~QuickStatus::any_rx);
  const uint8_t changed = quick ^ status_;
  return changed & (quick | QuickStatus::txif) & no_rx;
}

ROIO_MCP2515_MEMBER(uint8_t)::read_status() {
  if (running()) {
    look();
  }
  return read_quick_status();
}

/// Reads READ STATUS and takes in what it shows. Nonsense may come from a spike on the wires, once;
/// then it tells of a lost chip.
ROIO_MCP2515_MEMBER(void)::look() {
  // For a node that fills the bus time is worth more than room.
  const uint8_t nonsense = Traits::back_to_back ? take_in(read_quick_status()) : look_once();
  if (nonsense != 0 && look_once() != 0) {
    lose_chip();
  }
}

/// @return as take_in().
ROIO_MCP2515_MEMBER(uint8_t)::look_once() {
  return take_in(read_quick_status());
}

/// Takes in what READ STATUS showed.
/// @return 0; or what made no sense of it: it was not taken in, or came from a line that is at 1.
ROIO_MCP2515_MEMBER(uint8_t)::take_in(uint8_t quick) {
  const uint8_t nonsense = nonsense_in(quick);
  if (nonsense != 0) {
    return nonsense;
  }
  if ((status_ & QuickStatus::rx0) == 0 && (status_ & quick & QuickStatus::rx1) != 0) {
    quick &= static_cast<uint8_t>(~QuickStatus::rx0);  // newer: not before RXB1 was read
  }
  const uint8_t ended = requested() & static_cast<uint8_t>(~quick);
  status_ = quick;
  settle(ended);
  // A line that is at 1 looks as a chip does of which all buffers are in use; but it has no mode.
  return quick >= QuickStatus::all_in_use ? mode_differs_from(control_) : 0;
}

// --- the interrupt line --------------------------------------------------------------------------

/// Has the chip, in configuration mode, pull the line and let go of it again.
ROIO_MCP2515_MEMBER(void)::try_line() {
  if (Port::has_interrupt_line && Traits::doubts_line) {
    const bool falls = line_follows(true);
    const bool rises = line_follows(false);  // in any case: no flag may stay
    line().set_on(falls && rises);
  }
}

/// Has RX0IF, which pulls the line whoever sets it, and looks whether the line does.
ROIO_MCP2515_MEMBER(bool)::line_follows(bool low) {
  using mcp2515::Interrupt;
  constexpr uint8_t pulled = Interrupt::tx_any | Interrupt::rx0;
  write_register(Register::canintf, low ? pulled : Interrupt::tx_any);
  read_quick_status();  // the line has its time
  return port().interrupt_line_is_low() == low;
}

/// Until the next begin().
ROIO_MCP2515_MEMBER(void)::lose_line() {
  line().set_on(false);
  count(counters_.line_losses);
}

// --- errors and losses ---------------------------------------------------------------------------

/// What is done at the end of every call that has time.
/// @param looked whether READ STATUS has been read in this call.
ROIO_MCP2515_MEMBER(void)::tend(bool looked) {
  ++calls_;
  // When there is time, and at the latest when there has been none for long.
  const bool check = calls_ >= mcp2515::calls_between_checks &&
                     (received() == 0 || calls_ >= mcp2515::calls_at_most);
  // A line may keep silent for ever, and poll() alone does not receive.
  const bool must_look = check || !tx_queue().empty() || requests().aborting() ||
                         (Traits::reports_outcomes && requested() != 0);
  if (must_look && !looked && running()) {
    look();
  }
  if (!tx_queue().empty()) {
    pump();
  }
  if (check && running()) {
    calls_ = 0;
    check_chip();
  }
}

/// The next tend() that has time checks the chip.
ROIO_MCP2515_MEMBER(void)::check_soon() {
  calls_ |= mcp2515::calls_between_checks;
}

/// Looks at the error flags, and whether the chip is what begin() made of it.
ROIO_MCP2515_MEMBER(void)::check_chip() {
  using mcp2515::ErrorFlag;
  const uint8_t errors = read_register(Register::eflg);
  if (Traits::diagnoses && !diagnose(errors)) {
    lose_chip();
    return;
  }
  const uint8_t overflow = errors & ErrorFlag::any_overflow;
  if (overflow != 0) {
    count(counters_.overflows);
    write_register(Register::eflg, 0);  // no other bit can be written
  }
}

/// @return whether the chip is what begin() made of it.
ROIO_MCP2515_MEMBER(bool)::diagnose(uint8_t errors) {
  using mcp2515::Interrupt;
  const uint8_t flags = read_register(Register::canintf);
  const uint8_t status = read_register(Register::canstat);
  if ((flags & Interrupt::tx_any) != Interrupt::tx_any ||
      ((status ^ control_) & mcp2515::Control::mode_mask) != 0) {
    return false;
  }
  if ((flags & Interrupt::message_error) != 0) {
    count(counters_.message_errors);
    modify_register(Register::canintf, Interrupt::message_error, 0);
  }
  if ((errors & ~error_flags_ & mcp2515::ErrorFlag::bus_off) != 0) {
    count(counters_.bus_offs);
  }
  error_flags_ = errors;
  return true;
}

ROIO_MCP2515_MEMBER(void)::lose_chip() {
  count(counters_.chip_losses);
  forget_chip();
}

/// The chip has no memory of what it was told. What it had to send may or may not have gone out.
ROIO_MCP2515_MEMBER(void)::forget_chip() {
  const uint8_t unknown = static_cast<uint8_t>(requested() | requests().take_again());
  if (!Traits::reports_outcomes) {
    counters_.unknown = static_cast<typename Traits::Count>(counters_.unknown + in_flight());
  }
  status_ = 0;
  requests().set_aborting(false);
  if (Traits::diagnoses) {
    error_flags_ = 0;
  }
  if (Traits::reports_outcomes) {
    end(unknown, TxOutcome::unknown);
  }
}

ROIO_MCP2515_MEMBER(Mcp2515State)::state_of(uint8_t error_flags) {
  using mcp2515::ErrorFlag;
  return (error_flags & ErrorFlag::bus_off) != 0 ? Mcp2515State::bus_off
         : (error_flags & (ErrorFlag::rx_passive | ErrorFlag::tx_passive)) != 0
             ? Mcp2515State::passive
         : (error_flags & ErrorFlag::warning) != 0 ? Mcp2515State::warning
                                                   : Mcp2515State::active;
}

}  // namespace roio

#endif
