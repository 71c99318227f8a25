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

ROIO_MCP2515_MEMBER(uint8_t)::read_register(Register address) {
  RegisterAccess access(port(), Instruction::read, address);
  return access.exchange(0);
}

ROIO_MCP2515_MEMBER(void)::write_register(Register address, uint8_t value) {
  RegisterAccess access(port(), Instruction::write, address);
  access.put(value);
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

// --- what READ STATUS shows ----------------------------------------------------------------------

/// The three TXnIF are set, and the chip sends nothing but what it was told to. A chip that was
/// reset, and lines stuck at 0 or 1, look different; but for one that is at 1 when all buffers are
/// in use.
ROIO_MCP2515_MEMBER(bool)::is_plausible(uint8_t quick) {
  const uint8_t may_be = static_cast<uint8_t>(QuickStatus::any_rx | (status_ ^ QuickStatus::txif));
  return (quick & static_cast<uint8_t>(~may_be)) == QuickStatus::txif;
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
  for (uint8_t tries = 2; tries != 0; --tries) {
    if (take_in(read_quick_status())) {
      return;
    }
  }
  lose_chip();
}

/// Takes in what READ STATUS showed.
/// @return whether it was plausible.
ROIO_MCP2515_MEMBER(bool)::take_in(uint8_t quick) {
  if (quick == QuickStatus::everything) {
    return take_in_everything();
  }
  if (!is_plausible(quick)) {
    return false;
  }
  if (received() == QuickStatus::rx1 && (quick & QuickStatus::rx1) != 0) {
    quick &= static_cast<uint8_t>(~QuickStatus::rx0);  // newer: not before RXB1 was read
  }
  const uint8_t ended = requested() & static_cast<uint8_t>(~quick);
  status_ = quick;
  settle(ended);
  return true;
}

/// The same where a line that is at 1 looks as a chip does of which all buffers are in use: there
/// is no mode 7, which CANSTAT would have then.
ROIO_MCP2515_MEMBER(bool)::take_in_everything() {
  constexpr uint8_t no_mode = mcp2515::Control::mode_mask;
  if ((status_ | QuickStatus::any_rx) != QuickStatus::everything ||
      (read_register(Register::canstat) & no_mode) == no_mode) {
    return false;
  }
  if (received() != QuickStatus::rx1) {
    status_ = QuickStatus::everything;
  }
  return true;
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
  if (running()) {
    count(counters_.chip_losses);
  }
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
  error_flags_ = 0;
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
