/// Mcp2515, starting: begin(), what else resets the chip, and check_clock().
/// Included by mcp2515.hpp.
#ifndef ROIO_MCP2515_START_HPP
#define ROIO_MCP2515_START_HPP

#include <roio/mcp2515.hpp>

namespace roio {

namespace mcp2515 {
constexpr uint8_t setup_end = 0x30;
/// Whether it is behind the registers of a block: 00h..0Bh, 10h..1Bh and 20h..2Ch.
constexpr bool ends_setup_block(uint8_t address) {
  return (address & 0x2FU) == 0x0C || address == 0x2D;
}

/// Sent from the chip to itself to time its oscillator; no five equal bits up to the CRC.
constexpr uint32_t clock_frame_id = UINT32_C(0x0AAAAAAA);
constexpr uint8_t clock_frame_data = 0x55;
constexpr uint16_t clock_frame_bits = 131;
constexpr uint8_t clock_frames = 3;
constexpr uint8_t all_buffers = 7;            ///< In RTS.
constexpr uint32_t slowest_osc_hz = 1000000;  ///< The chip takes 1 to 40 MHz.
constexpr uint32_t clock_timeout_us = 20000;
constexpr uint8_t slowest_clock_factor = 12;  ///< 4 MHz told 40, and some more.
constexpr uint8_t clock_tolerance = 8;  ///< One part in so many; crystals in use are 1 in 4 apart.
}  // namespace mcp2515

/// Asks the chip to enter a mode: configuration mode by a reset.
/// @param control what CANCTRL is to be.
/// @return whether it is there a little later. If not it may need more time; or a reset came before
///         the oscillator runs, and is lost: in both cases again.
ROIO_MCP2515_MEMBER(bool)::enters(uint8_t control) {
  using mcp2515::Control;
  if (control == Control::after_reset) {
    const Transaction transaction(port(), static_cast<uint8_t>(Instruction::reset));
  } else {
    write_register(Register::canctrl, control);
  }
  port().pause(mcp2515::pause_us);
  return mode_differs_from(control) == 0;
}

/// The same, as often as it takes.
/// @return how many tries were left; 0: it is not there.
ROIO_MCP2515_MEMBER(uint8_t)::reach(uint8_t control) {
  uint8_t left = mcp2515::pauses;
  while (!enters(control) && --left != 0) {
  }
  return left;
}

/// Writes filters, masks, timing and interrupt flags, and reads them back. The three TXnIF are set
/// there and never cleared, so that every READ STATUS shows whether the chip still knows what it
/// was told.
/// @return whether all are as they have to be.
ROIO_MCP2515_MEMBER_OF(Setup, bool)::exchange_setup(const Setup& setup) {
  constexpr uint8_t writing = static_cast<uint8_t>(Instruction::write);
  constexpr uint8_t reading = static_cast<uint8_t>(Instruction::read);
  static_assert(reading == writing + 1, "first it is written, then it is read");
  uint8_t differences = 0;
  for (uint8_t instruction = writing; instruction != reading + 1; ++instruction) {
    differences = 0;  // what a chip that is written to answers is nothing
    uint8_t address = 0;
    do {
      RegisterAccess access(port(), static_cast<Instruction>(instruction),
                            static_cast<Register>(address));
      do {
        const uint8_t byte = setup[address];
        differences |= static_cast<uint8_t>(access.exchange(byte) ^ byte);
        ++address;
      } while (!mcp2515::ends_setup_block(address));
      address = static_cast<uint8_t>((address | 0x0FU) + 1U);  // of the next block
    } while (address != mcp2515::setup_end);
  }
  return differences == 0;
}

/// Writes what the registers have to be, and reads it back.
ROIO_MCP2515_MEMBER_OF(Setup, bool)::configure(const Setup& setup) {
  using mcp2515::Interrupt;
  using mcp2515::RxControl;
  constexpr uint8_t rx0 = RxControl::by_filters | RxControl::rollover;
  write_register(Register::rxb0ctrl, rx0);
  if ((read_register(Register::rxb0ctrl) & RxControl::settings) != rx0 || !exchange_setup(setup)) {
    return false;
  }
  for (uint8_t buffer = mcp2515::urgent_buffer; Traits::reports_outcomes && buffer != 0;
       buffer >>= 1) {
    write_register(mcp2515::txbctrl(buffer), order().level_of(buffer));
    if (read_register(mcp2515::txbctrl(buffer)) != order().level_of(buffer)) {
      return false;
    }
  }
  if (Port::has_interrupt_line) {
    constexpr uint8_t received = Interrupt::rx0 | Interrupt::rx1;
    write_register(Register::caninte, received);
    if (read_register(Register::caninte) != received) {
      return false;
    }
  }
  return true;
}

/// @return whether the chip is there, and in configuration mode.
ROIO_MCP2515_MEMBER(bool)::reset_chip() {
  forget_chip();
  return reach(mcp2515::Control::after_reset) != 0;
}

ROIO_MCP2515_MEMBER(Status)::begin(const Mcp2515Config& config) {
  using mcp2515::Control;
  if (!config.timing_is_valid()) {
    return Status::bad_timing;
  }
  if (mcp2515::is_rest(Control::mode_of(config.control())) ||
      (!Traits::reports_outcomes && (config.control() & Control::one_shot) != 0)) {
    return Status::bad_argument;
  }
  return start(config);
}

/// Into configuration mode, to be set up, and from there into the mode that is asked for.
ROIO_MCP2515_MEMBER_OF(Setup, Status)::start(const Setup& setup) {
  using mcp2515::Control;
  count_what_is_forgotten();
  forget_chip();
  control_ = setup.control();
  if (reach(Control::after_reset) == 0 || !configure(setup)) {
    return Status::no_chip;
  }
  try_line();
  if (reach(setup.control()) != 0) {
    status_ = QuickStatus::txif;
    if (Port::has_interrupt_line && !line().is_on()) {
      lose_line();
    }
    return Status::ok;
  }
  // Not later either, when nobody expects it any more.
  write_register(Register::canctrl, Control::after_reset);
  return Status::wrong_mode;
}

ROIO_MCP2515_MEMBER(Status)::stop() {
  count_what_is_forgotten();
  control_ = 0;  // no mode that change_mode() could come back from
  return reset_chip() ? Status::ok : Status::no_chip;
}

/// Losses that the chip knows of, and frames that nobody has read.
ROIO_MCP2515_MEMBER(void)::count_what_is_forgotten() {
  if (!Traits::diagnoses || !running()) {
    return;
  }
  check_chip();
  if (running()) {
    look();
  }
  if (running()) {
    const uint8_t quick = read_quick_status();  // status_ need not have both
    counters_.discarded += (quick & QuickStatus::rx0) != 0 ? 1 : 0;
    counters_.discarded += (quick & QuickStatus::rx1) != 0 ? 1 : 0;
  }
}

ROIO_MCP2515_MEMBER(Status)::check_clock(const Mcp2515Config& config, uint32_t osc_hz,
                                         uint32_t& measured_hz) {
  using mcp2515::Control;
  measured_hz = 0;
  if (osc_hz < mcp2515::slowest_osc_hz) {
    return Status::bad_argument;
  }
  if (!config.timing_is_valid()) {
    return Status::bad_timing;
  }
  if (!reset_chip() || !configure(config)) {
    return Status::no_chip;
  }
  if (reach(static_cast<uint8_t>(mcp2515::Mode::loopback) | Control::clock_out) == 0) {
    return Status::wrong_mode;
  }
  const uint32_t clocks =
      UINT32_C(1) * mcp2515::clock_frames * mcp2515::clock_frame_bits * config.clocks_per_bit();
  const uint32_t expected_us = clocks / (osc_hz / 1000U) * 1000U;
  load_clock_frames();
  const uint32_t limit_us = mcp2515::clock_timeout_us + mcp2515::slowest_clock_factor * expected_us;
  const uint32_t elapsed_us = time_clock_frames(limit_us);
  // Also ends what may still be under way.
  if (reach(Control::after_reset) == 0 || elapsed_us == 0) {
    return Status::no_chip;
  }
  if (elapsed_us >= limit_us) {
    return Status::wrong_clock;
  }
  const uint32_t measured_khz = clocks * 100U / elapsed_us * 10U;
  const uint32_t told_khz = osc_hz / 1000U;
  const uint32_t difference =
      measured_khz > told_khz ? measured_khz - told_khz : told_khz - measured_khz;
  measured_hz = measured_khz * 1000U;
  return difference <= told_khz / mcp2515::clock_tolerance ? Status::ok : Status::wrong_clock;
}

/// One and the same frame into all three transmit buffers.
ROIO_MCP2515_MEMBER(void)::load_clock_frames() {
  for (uint8_t buffer = mcp2515::urgent_buffer; buffer != 0; buffer >>= 1) {
    Frame frame = {mcp2515::clock_frame_id, FrameKind::extended, max_data_length, {}};
    for (uint8_t& byte : frame.data) {
      byte = mcp2515::clock_frame_data;
    }
    const Mcp2515Frame bytes = mcp2515::to_chip(frame);
    Transaction transaction(port(), mcp2515::load_tx(buffer));
    transaction.send(bytes.bytes, sizeof bytes.bytes);
  }
}

/// Sends them, and waits until all are gone.
/// @return how long that took, or some time from limit_us on.
ROIO_MCP2515_MEMBER(uint32_t)::time_clock_frames(uint32_t limit_us) {
  { const Transaction transaction(port(), mcp2515::request_to_send(mcp2515::all_buffers)); }
  const uint32_t start = port().microseconds();
  uint32_t elapsed_us = 0;
  // A clock that stands still (interrupts are off) must not keep anybody here: a look takes 2 us.
  uint32_t looks = limit_us / 2U;
  do {
    elapsed_us = port().microseconds() - start;
  } while ((read_quick_status() & QuickStatus::any_txreq) != 0 && elapsed_us < limit_us &&
           --looks != 0);
  return elapsed_us;
}

}  // namespace roio

#endif
