// What mcp2515.hpp declares. Included by it, never by itself.
#ifndef ROIO_MCP2515_IMPL_HPP
#define ROIO_MCP2515_IMPL_HPP

#include <roio/mcp2515.hpp>

/// A member function of the driver, without its template arguments each time.
#define ROIO_MCP2515_MEMBER(Type)                                             \
  template <typename Port, uint8_t RxQueue, uint8_t TxQueue, typename Traits> \
  Type Mcp2515<Port, RxQueue, TxQueue, Traits>

namespace roio {

namespace mcp2515 {
constexpr uint8_t no_slot = 0xFF;
constexpr uint8_t standard_id_shift = 18;    ///< Where the 11 bits lie among the 29.
constexpr uint16_t start_up_us = 200;        ///< 128 clocks (8.1) of any oscillator above 640 kHz.
constexpr uint32_t mode_timeout_us = 50000;  ///< One frame at 5 kbit/s, and 11 bits.
constexpr uint8_t calls_between_checks = 64;

/// Sent from the chip to itself to time its oscillator; no five equal bits up to the CRC.
constexpr uint32_t clock_frame_id = UINT32_C(0x0AAAAAAA);
constexpr uint8_t clock_frame_data = 0x55;
constexpr uint16_t clock_frame_bits = 131;
constexpr uint8_t clock_frames = 3;
constexpr uint32_t slowest_osc_hz = 1000000;  ///< The chip takes 1 to 40 MHz.
constexpr uint32_t clock_timeout_us = 20000;
constexpr uint8_t slowest_clock_factor = 12;  ///< 4 MHz told 40, and some more.
constexpr uint8_t clock_tolerance = 8;  ///< One part in so many; crystals in use are 1 in 4 apart.
}  // namespace mcp2515

// --- single accesses -----------------------------------------------------------------------------

ROIO_MCP2515_MEMBER(uint8_t)::read_register(Register address) {
  uint8_t value = 0;
  read_registers(address, &value, 1);
  return value;
}

ROIO_MCP2515_MEMBER(void)::read_registers(Register address, uint8_t* values, uint8_t count) {
  Transaction transaction(port_);
  transaction.exchange(static_cast<uint8_t>(Instruction::read));
  transaction.exchange(static_cast<uint8_t>(address));
  for (uint8_t i = 0; i < count; ++i) {
    values[i] = transaction.exchange(0);
  }
}

ROIO_MCP2515_MEMBER(void)::write_registers(Register address, const uint8_t* values, uint8_t count) {
  Transaction transaction(port_);
  transaction.exchange(static_cast<uint8_t>(Instruction::write));
  transaction.exchange(static_cast<uint8_t>(address));
  for (uint8_t i = 0; i < count; ++i) {
    transaction.exchange(values[i]);
  }
}

ROIO_MCP2515_MEMBER(void)::modify_register(Register address, uint8_t mask, uint8_t value) {
  Transaction transaction(port_);
  transaction.exchange(static_cast<uint8_t>(Instruction::bit_modify));
  transaction.exchange(static_cast<uint8_t>(address));
  transaction.exchange(mask);
  transaction.exchange(value);
}

ROIO_MCP2515_MEMBER(bool)::write_and_compare(Register address, const uint8_t* values,
                                             uint8_t count) {
  write_registers(address, values, count);
  Transaction transaction(port_);
  transaction.exchange(static_cast<uint8_t>(Instruction::read));
  transaction.exchange(static_cast<uint8_t>(address));
  bool same = true;
  for (uint8_t i = 0; i < count; ++i) {
    same = transaction.exchange(0) == values[i] && same;
  }
  return same;
}

ROIO_MCP2515_MEMBER(uint8_t)::read_quick_status() {
  Transaction transaction(port_);
  transaction.exchange(static_cast<uint8_t>(Instruction::read_status));
  return transaction.exchange(0);
}

ROIO_MCP2515_MEMBER(void)::read_error_counters(uint8_t& transmit, uint8_t& receive) {
  uint8_t counters[2];
  read_registers(Register::tec, counters, 2);
  transmit = counters[0];
  receive = counters[1];
}

// --- starting ------------------------------------------------------------------------------------

ROIO_MCP2515_MEMBER(void)::pause(uint16_t microseconds) {
  const uint32_t start = port_.microseconds();
  while (port_.microseconds() - start < microseconds) {
  }
}

// A reset that comes before the oscillator runs is lost, so it is repeated until the registers show
// one.
ROIO_MCP2515_MEMBER(bool)::reset_chip(uint16_t timeout_ms) {
  const uint32_t start = port_.microseconds();
  do {
    {
      Transaction transaction(port_);
      transaction.exchange(static_cast<uint8_t>(Instruction::reset));
    }
    pause(mcp2515::start_up_us);
    uint8_t values[2];  // CANSTAT, CANCTRL
    read_registers(Register::canstat, values, 2);
    if (values[0] == static_cast<uint8_t>(mcp2515::Mode::configuration) &&
        (values[1] & ~mcp2515::Control::mode_mask) == mcp2515::Control::clock_out) {
      return true;
    }
  } while (port_.microseconds() - start < timeout_ms * UINT32_C(1000));
  return false;
}

ROIO_MCP2515_MEMBER(bool)::configure(const Mcp2515Config& config) {
  using mcp2515::Cnf;
  using mcp2515::Interrupt;
  using mcp2515::RxControl;
  const Mcp2515Filters& filters = config.filters;
  const uint8_t interrupts = Port::has_interrupt_line ? Interrupt::rx0 | Interrupt::rx1 : 0;
  // From the masks on: CNF3, CNF2, CNF1, CANINTE, CANINTF. The three TXnIF are set and never
  // cleared, so that every READ STATUS shows whether the chip still knows what it was told.
  const uint8_t setup[13] = {
      filters.mask[0][0],       filters.mask[0][1],       filters.mask[0][2],
      filters.mask[0][3],       filters.mask[1][0],       filters.mask[1][1],
      filters.mask[1][2],       filters.mask[1][3],       Cnf::cnf3(config.timing),
      Cnf::cnf2(config.timing), Cnf::cnf1(config.timing), interrupts,
      Interrupt::tx_any};
  bool same = write_and_compare(Register::rxf0sidh, filters.filter[0], 12);
  same = write_and_compare(Register::rxf3sidh, filters.filter[3], 12) && same;
  same = write_and_compare(Register::rxm0sidh, setup, sizeof setup) && same;
  const uint8_t rx0 = RxControl::by_filters | RxControl::rollover;
  const uint8_t rx1 = RxControl::by_filters;
  write_registers(Register::rxb0ctrl, &rx0, 1);
  write_registers(Register::rxb1ctrl, &rx1, 1);
  // These two also tell of frames received.
  same = (read_register(Register::rxb0ctrl) & RxControl::settings) == rx0 && same;
  same = (read_register(Register::rxb1ctrl) & RxControl::settings) == rx1 && same;
  for (uint8_t slot = 0; slot < 3; ++slot) {
    priority_[slot] = slot == urgent_slot ? urgent_level : highest_normal_level;
    same = write_and_compare(mcp2515::txbctrl(slot), &priority_[slot], 1) && same;
  }
  return same;
}

ROIO_MCP2515_MEMBER(bool)::enter_mode(uint8_t control) {
  write_registers(Register::canctrl, &control, 1);
  const uint32_t start = port_.microseconds();
  do {
    // CANCTRL with it: the 0 of normal mode could be that of a line that says nothing.
    uint8_t values[2];  // CANSTAT, CANCTRL
    read_registers(Register::canstat, values, 2);
    if (((values[0] ^ control) & mcp2515::Control::mode_mask) == 0 && values[1] == control) {
      return true;
    }
  } while (port_.microseconds() - start < mcp2515::mode_timeout_us);
  return false;
}

ROIO_MCP2515_MEMBER(Status)::begin(const Mcp2515Config& config) {
  using mcp2515::Control;
  if (!is_valid(config.timing)) {
    return Status::bad_timing;
  }
  if (!config.filters.in_order || config.mode == mcp2515::Mode::configuration) {
    return Status::bad_argument;
  }
  if (running_) {
    count_what_begin_forgets();
  }
  forget_chip();
  if (!reset_chip(config.start_timeout_ms) || !configure(config)) {
    return Status::no_chip;
  }
  control_ = static_cast<uint8_t>(static_cast<uint8_t>(config.mode) | Control::clock_out |
                                  (config.one_shot ? Control::one_shot : 0));
  if (!enter_mode(control_)) {
    // Not later either, when nobody expects it any more.
    const uint8_t configuration =
        static_cast<uint8_t>(mcp2515::Mode::configuration) | Control::clock_out;
    write_registers(Register::canctrl, &configuration, 1);
    return Status::wrong_mode;
  }
  running_ = true;
  return Status::ok;
}

/// Losses that the chip knows of, and frames that nobody has read.
ROIO_MCP2515_MEMBER(void)::count_what_begin_forgets() {
  check_chip();
  if (running_) {
    note(read_quick_status());
    counters_.discarded += (quick_ & QuickStatus::rx0) != 0 ? 1 : 0;
    counters_.discarded += (quick_ & QuickStatus::rx1) != 0 ? 1 : 0;
  }
}

ROIO_MCP2515_MEMBER(Status)::check_clock(const Mcp2515Config& config, uint32_t osc_hz,
                                         uint32_t& measured_hz) {
  using mcp2515::Control;
  measured_hz = 0;
  if (!is_valid(config.timing)) {
    return Status::bad_timing;
  }
  if (osc_hz < mcp2515::slowest_osc_hz) {
    return Status::bad_argument;
  }
  forget_chip();
  if (!reset_chip(config.start_timeout_ms) || !configure(config)) {
    return Status::no_chip;
  }
  if (!enter_mode(static_cast<uint8_t>(mcp2515::Mode::loopback) | Control::clock_out)) {
    return Status::wrong_mode;
  }
  const uint32_t clocks = UINT32_C(2) * mcp2515::clock_frames * mcp2515::clock_frame_bits *
                          config.timing.prescaler * quanta_per_bit(config.timing);
  const uint32_t expected_us = clocks / (osc_hz / 1000U) * 1000U;
  load_clock_frames();
  const uint32_t limit_us = mcp2515::clock_timeout_us + mcp2515::slowest_clock_factor * expected_us;
  const uint32_t elapsed_us = time_clock_frames(limit_us);
  // Also ends what may still be under way.
  if (!reset_chip(config.start_timeout_ms) || elapsed_us == 0) {
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
  uint8_t id[4];
  to_mcp2515_registers(mcp2515::clock_frame_id, id);
  for (uint8_t slot = 0; slot < mcp2515::clock_frames; ++slot) {
    Transaction transaction(port_);
    transaction.exchange(mcp2515::load_tx(slot));
    transaction.exchange(id[0]);
    transaction.exchange(static_cast<uint8_t>(id[1] | mcp2515::extended_bit));
    transaction.exchange(id[2]);
    transaction.exchange(id[3]);
    transaction.exchange(max_data_length);
    for (uint8_t i = 0; i < max_data_length; ++i) {
      transaction.exchange(mcp2515::clock_frame_data);
    }
  }
}

/// Sends them, and waits until all are gone.
/// @return how long that took, or some time from limit_us on.
ROIO_MCP2515_MEMBER(uint32_t)::time_clock_frames(uint32_t limit_us) {
  constexpr uint8_t requested =
      QuickStatus::txreq(0) | QuickStatus::txreq(1) | QuickStatus::txreq(2);
  {
    Transaction transaction(port_);
    transaction.exchange(mcp2515::request_to_send(0) | mcp2515::request_to_send(1) |
                         mcp2515::request_to_send(2));
  }
  const uint32_t start = port_.microseconds();
  uint32_t elapsed_us = 0;
  do {
    elapsed_us = port_.microseconds() - start;
  } while ((read_quick_status() & requested) != 0 && elapsed_us < limit_us);
  return elapsed_us;
}

// --- what READ STATUS shows ----------------------------------------------------------------------

/// The three TXnIF are set, and the chip sends nothing but what it was told to. A chip that was
/// reset, and lines stuck at 0 or 1, look different.
ROIO_MCP2515_MEMBER(bool)::is_plausible(uint8_t quick) const {
  return (quick & static_cast<uint8_t>(~(QuickStatus::any_rx | pending_))) == QuickStatus::txif;
}

/// @param freed_rx0 this is the look right after RXB0 was freed.
ROIO_MCP2515_MEMBER(void)::note(uint8_t quick, bool freed_rx0) {
  fresh_ = true;
  const bool nonsense = !is_plausible(quick);
  // All buffers in use looks like a line stuck at 1: that wants a second opinion, too.
  if (nonsense || quick == QuickStatus::everything) {
    check_chip();
    quick = running_ ? read_quick_status() : 0;
    // The second look comes later: two frames may be in by now, and nothing tells their order.
    const bool order_lost =
        nonsense && freed_rx0 && (quick & QuickStatus::any_rx) == QuickStatus::any_rx;
    if (order_lost || !is_plausible(quick)) {
      lose_chip();
      return;
    }
  }
  quick_ = quick & QuickStatus::any_rx;
  settle(quick);
}

// --- receiving -----------------------------------------------------------------------------------

/// Whether a frame waits in the chip, as far as is known or can be seen. A line that is low is no
/// frame yet: it may be stuck, or a spike.
ROIO_MCP2515_MEMBER(bool)::find_received() {
  const bool may_have = !fresh_ && (!Port::has_interrupt_line || port_.interrupt_line_is_low());
  if (quick_ == 0 && may_have) {
    note(read_quick_status());
  }
  return running_ && quick_ != 0;
}

/// Takes the older frame out of the chip. There must be one.
/// @return whether it is one for the program.
ROIO_MCP2515_MEMBER(bool)::fetch(Frame& frame) {
  const bool first = (quick_ & QuickStatus::rx0) != 0 && !rx1_is_older_;
  if (!read_rx_buffer(first ? 0 : 1, frame)) {
    return false;
  }
  if (!Traits::all_kinds && frame.kind != FrameKind::extended) {
    ++counters_.foreign;
    return false;
  }
  ++counters_.received;
  return true;
}

/// Reads a buffer, which frees it, and looks what has come meanwhile.
///
/// The order of two full buffers is in no register; it follows from what was seen when. RXB0 is
/// filled first, RXB1 only while RXB0 is full. So of two full buffers RXB0 is the older one, unless
/// RXB1 was full already when RXB0 was freed. Whether it was, shows right after: a frame takes
/// longer on the bus than the look does, so at most one can have come in between, and that one went
/// to RXB0. Nothing may interrupt the two. The look also tells that the chip was there all the
/// while, and it is the next call's first.
/// With an interrupt line: a buffer that is full holds it low, so a line that is high before the
/// buffer is freed tells of a chip that was reset or fell off; one that is high after it, that
/// nothing more is there, and spares the look.
/// @return false: the chip was lost meanwhile, or the line says so; the frame cannot be trusted.
ROIO_MCP2515_MEMBER(bool)::read_rx_buffer(uint8_t buffer, Frame& frame) {
  uint8_t quick = 0;
  bool trusted = true;
  bool looks = true;
  {
    Transaction transaction(port_);
    read_frame(transaction, buffer, frame);
    trusted = !Port::has_interrupt_line || port_.interrupt_line_is_low();
    typename Port::Uninterrupted together(port_);
    transaction.restart();
    looks = !Port::has_interrupt_line || !trusted || port_.interrupt_line_is_low();
    if (looks) {
      transaction.exchange(static_cast<uint8_t>(Instruction::read_status));
      quick = transaction.exchange(0);
    }
  }
  quick_ = 0;
  if (looks) {
    note(quick, buffer == 0);
  }
  rx1_is_older_ = buffer == 0 && (quick_ & QuickStatus::rx1) != 0;
  // Perhaps both were full for a while, and a third frame was lost.
  check_due_ = check_due_ || (quick_ != 0 && (buffer == 1 || rx1_is_older_));
  trusted = trusted && running_;
  if (!trusted) {
    ++counters_.discarded;
  }
  return trusted;
}

/// The buffer's bytes, only as many as the frame has. DLC 9..15 is 8 bytes (ISO 11898-1).
ROIO_MCP2515_MEMBER(void)::read_frame(Transaction& transaction, uint8_t buffer, Frame& frame) {
  transaction.exchange(mcp2515::read_rx(buffer));
  uint8_t id[4];
  for (uint8_t& byte : id) {
    byte = transaction.exchange(0);
  }
  const uint8_t dlc = transaction.exchange(0);
  const bool extended = (id[1] & mcp2515::extended_bit) != 0;
  const bool remote =
      extended ? (dlc & mcp2515::remote_bit) != 0 : (id[1] & mcp2515::standard_remote_bit) != 0;
  frame.id = from_mcp2515_registers(id);
  if (Traits::all_kinds && !extended) {
    frame.id >>= mcp2515::standard_id_shift;
  }
  frame.kind = extended ? (remote ? FrameKind::extended_remote : FrameKind::extended)
                        : (remote ? FrameKind::standard_remote : FrameKind::standard);
  frame.length = dlc & 0x0FU;
  if (frame.length > max_data_length) {
    frame.length = max_data_length;
  }
  for (uint8_t i = 0; i < max_data_length; ++i) {
    frame.data[i] = !remote && i < frame.length ? transaction.exchange(0) : uint8_t{0};
  }
}

ROIO_MCP2515_MEMBER(Status)::receive(Frame& frame) {
  if (rx_queue_.empty() && RxQueue > 0) {
    poll();
  }
  if (!rx_queue_.empty()) {
    frame = rx_queue_.front();
    rx_queue_.pop();
    return Status::ok;
  }
  if (!running_) {
    return Status::no_chip;
  }
  bool received = false;
  if (RxQueue == 0) {
    fresh_ = false;
    // As many as the chip holds, so that frames for others keep nobody here.
    for (uint8_t i = 0; i < 2 && !received && find_received(); ++i) {
      received = fetch(frame);
    }
    tend();
  }
  return received ? Status::ok : running_ ? Status::empty : Status::no_chip;
}

ROIO_MCP2515_MEMBER(Status)::poll() {
  if (!running_) {
    return Status::no_chip;
  }
  fresh_ = false;
  for (uint8_t i = 0; i < RxQueue + 2U && !rx_queue_.full() && find_received(); ++i) {
    if (fetch(rx_queue_.next())) {
      rx_queue_.commit();
    }
  }
  tend();
  return running_ ? Status::ok : Status::no_chip;
}

// --- sending -------------------------------------------------------------------------------------

ROIO_MCP2515_MEMBER(Status)::send(const Frame& frame, uint8_t token) {
  if (!is_sendable(frame)) {
    return Status::bad_argument;
  }
  if (!running_) {
    return Status::no_chip;
  }
  if ((control_ & mcp2515::Control::mode_mask) ==
      static_cast<uint8_t>(mcp2515::Mode::listen_only)) {
    return Status::wrong_mode;
  }
  if (!give_to_chip(frame, token)) {
    // Only the chip knows whether it has room by now.
    note(read_quick_status());
    pump();
    if (!running_) {
      return Status::no_chip;
    }
    if (!give_to_chip(frame, token)) {
      return enqueue(frame, token);
    }
  }
  return Status::ok;
}

/// Whether no frame waits that has to go first, and the chip has room; then it is there.
ROIO_MCP2515_MEMBER(bool)::give_to_chip(const Frame& frame, uint8_t token) {
  const bool goes_next =
      tx_queue_.empty() || (is_urgent(frame) && !is_urgent(tx_queue_.front().frame));
  return goes_next && load(frame, token);
}

ROIO_MCP2515_MEMBER(Status)::enqueue(const Frame& frame, uint8_t token) {
  if (tx_queue_.full() || aborting_) {
    return Status::full;
  }
  uint8_t place = tx_queue_.size();
  tx_queue_.commit();
  if (is_urgent(frame)) {
    while (place > 0) {
      const uint8_t ahead = static_cast<uint8_t>(place - 1U);
      if (is_urgent(tx_queue_[ahead].frame)) {
        break;
      }
      tx_queue_[place] = tx_queue_[ahead];
      place = ahead;
    }
  }
  tx_queue_[place].frame = frame;
  tx_queue_[place].token = token;
  return Status::ok;
}

ROIO_MCP2515_MEMBER(void)::pump() {
  while (!tx_queue_.empty() && load(tx_queue_.front().frame, tx_queue_.front().token)) {
    tx_queue_.pop();
  }
}

/// Which transmit buffer the next frame may go to, and with which priority.
///
/// The chip sends the highest TXP first and, among equals, the highest buffer. So a frame that must
/// come after the one in buffer 2 goes to buffer 1 with the same TXP, and one that must come after
/// the one in buffer 1 to buffer 2 with a lower TXP; at 0 the chip has to run empty once. Buffer 0
/// has TXP 3, above all of these, and takes no normal frame: so an urgent one never waits for a
/// normal one to win the bus.
ROIO_MCP2515_MEMBER(uint8_t)::choose_slot(bool urgent, uint8_t& level) const {
  if (urgent || Traits::only_buffer_0) {
    level = urgent_level;
    return (pending_ & QuickStatus::txreq(0)) == 0 ? urgent_slot : mcp2515::no_slot;
  }
  const bool in_1 = (pending_ & QuickStatus::txreq(1)) != 0;
  const bool in_2 = (pending_ & QuickStatus::txreq(2)) != 0;
  level = in_1 || in_2 ? level_ : highest_normal_level;
  if (!in_1) {
    return in_2 ? 1 : 2;
  }
  if (in_2 || level == 0) {
    return mcp2515::no_slot;
  }
  --level;
  return 2;
}

ROIO_MCP2515_MEMBER(bool)::load(const Frame& frame, uint8_t token) {
  uint8_t level = 0;
  const bool accepts = running_ && !aborting_;
  const uint8_t slot = accepts ? choose_slot(is_urgent(frame), level) : mcp2515::no_slot;
  if (slot == mcp2515::no_slot) {
    return false;
  }
  const bool extended = !Traits::all_kinds || is_extended(frame.kind);
  uint8_t id[4];
  to_mcp2515_registers(extended ? frame.id : frame.id << mcp2515::standard_id_shift, id);
  {
    Transaction transaction(port_);
    if (priority_[slot] == level) {
      transaction.exchange(mcp2515::load_tx(slot));
    } else {
      // TXBnCTRL lies right before the buffer: one write does for both.
      transaction.exchange(static_cast<uint8_t>(Instruction::write));
      transaction.exchange(static_cast<uint8_t>(mcp2515::txbctrl(slot)));
      transaction.exchange(level);
      priority_[slot] = level;
    }
    transaction.exchange(id[0]);
    transaction.exchange(static_cast<uint8_t>(id[1] | (extended ? mcp2515::extended_bit : 0U)));
    transaction.exchange(id[2]);
    transaction.exchange(id[3]);
    const bool remote = Traits::all_kinds && is_remote(frame.kind);
    transaction.exchange(static_cast<uint8_t>(frame.length | (remote ? mcp2515::remote_bit : 0U)));
    for (uint8_t i = 0; i < frame.length && !remote; ++i) {
      transaction.exchange(frame.data[i]);
    }
    // By RTS, never by writing TXREQ: errata item 5.
    transaction.restart();
    transaction.exchange(mcp2515::request_to_send(slot));
  }
  pending_ |= QuickStatus::txreq(slot);
  token_[slot] = token;
  if (slot != urgent_slot) {
    level_ = level;
  }
  return true;
}

/// Finds the transmissions that have come to their end.
ROIO_MCP2515_MEMBER(void)::settle(uint8_t quick) {
  const uint8_t ended = static_cast<uint8_t>(pending_ & ~quick);
  pending_ &= quick;
  uint8_t bit = QuickStatus::txreq(0);
  for (uint8_t slot = 0; ended != 0 && slot < 3; ++slot, bit = static_cast<uint8_t>(bit << 2)) {
    if ((ended & bit) != 0) {
      report(token_[slot], outcome_of(slot));
    }
  }
  if (aborting_ && pending_ == 0) {
    modify_register(Register::canctrl, mcp2515::Control::abort_all, 0);
    aborting_ = false;
  }
}

/// A request ends by success, unless somebody has asked for less.
ROIO_MCP2515_MEMBER(TxOutcome)::outcome_of(uint8_t slot) {
  using mcp2515::TxControl;
  const bool one_shot = (control_ & mcp2515::Control::one_shot) != 0;
  if (!aborting_ && !one_shot) {
    return TxOutcome::sent;
  }
  const uint8_t control = read_register(mcp2515::txbctrl(slot));
  if ((control & TxControl::fixed) != priority_[slot]) {
    return TxOutcome::unknown;  // that is no answer of a chip that has ended this request
  }
  if ((control & (TxControl::lost_arbitration | TxControl::error)) != 0 && one_shot) {
    return TxOutcome::failed;
  }
  return (control & TxControl::aborted) != 0 ? TxOutcome::aborted : TxOutcome::sent;
}

ROIO_MCP2515_MEMBER(void)::report(uint8_t token, TxOutcome outcome) {
  if (outcome == TxOutcome::sent) {
    ++counters_.sent;
  } else if (outcome == TxOutcome::unknown) {
    ++counters_.unknown;
  } else {
    ++counters_.not_sent;
  }
  traits_.on_outcome(token, outcome);
}

ROIO_MCP2515_MEMBER(void)::abort() {
  while (!tx_queue_.empty()) {
    const uint8_t token = tx_queue_.front().token;
    tx_queue_.pop();
    report(token, TxOutcome::aborted);
  }
  if (running_ && pending_ != 0) {
    aborting_ = true;
    modify_register(Register::canctrl, mcp2515::Control::abort_all, mcp2515::Control::abort_all);
  }
}

// --- looking after the chip ----------------------------------------------------------------------

/// What is done at the end of every call that has time.
ROIO_MCP2515_MEMBER(void)::tend() {
  ++calls_;
  const bool check = calls_ >= mcp2515::calls_between_checks;
  const bool somebody_waits =
      !tx_queue_.empty() || aborting_ || (pending_ != 0 && (Traits::reports_outcomes || check));
  if (running_ && somebody_waits && !fresh_) {
    note(read_quick_status());
  }
  if (running_) {
    pump();
  }
  if (running_ && (check || (check_due_ && quick_ == 0))) {
    check_chip();
  }
}

/// Looks whether the chip is what begin() made of it, and at its error flags.
ROIO_MCP2515_MEMBER(void)::check_chip() {
  using mcp2515::Control;
  using mcp2515::ErrorFlag;
  using mcp2515::Interrupt;
  uint8_t values[4];  // CANINTF, EFLG, CANSTAT, CANCTRL
  read_registers(Register::canintf, values, sizeof values);
  const uint8_t flags = values[0];
  const uint8_t errors = values[1];
  calls_ = 0;
  check_due_ = false;
  if (quick_ == 0) {
    quick_ = flags & QuickStatus::any_rx;  // also when the interrupt line keeps silent about them
  }
  if ((flags & Interrupt::tx_any) != Interrupt::tx_any ||
      ((values[2] ^ control_) & Control::mode_mask) != 0 ||
      (values[3] & ~Control::abort_all) != control_) {
    lose_chip();
    return;
  }
  const uint8_t seen = flags & (Interrupt::error | Interrupt::message_error);
  if (seen != 0) {
    modify_register(Register::canintf, seen, 0);
  }
  if ((seen & Interrupt::message_error) != 0) {
    ++counters_.message_errors;
  }
  if ((errors & ErrorFlag::any_overflow) != 0) {
    ++counters_.overflows;
    modify_register(Register::eflg, errors & ErrorFlag::any_overflow, 0);
  }
  if ((errors & ~error_flags_ & ErrorFlag::bus_off) != 0) {
    ++counters_.bus_offs;
  }
  error_flags_ = errors;
}

ROIO_MCP2515_MEMBER(void)::lose_chip() {
  if (running_) {
    ++counters_.chip_losses;
  }
  forget_chip();
}

/// The chip has no memory of what it was told. What it had to send may or may not have gone out.
ROIO_MCP2515_MEMBER(void)::forget_chip() {
  running_ = false;
  quick_ = 0;
  rx1_is_older_ = false;
  aborting_ = false;
  check_due_ = false;
  error_flags_ = 0;
  uint8_t bit = QuickStatus::txreq(0);
  for (uint8_t slot = 0; slot < 3; ++slot, bit = static_cast<uint8_t>(bit << 2)) {
    if ((pending_ & bit) != 0) {
      report(token_[slot], TxOutcome::unknown);
    }
  }
  pending_ = 0;
}

ROIO_MCP2515_MEMBER(Mcp2515State)::state() const {
  using mcp2515::ErrorFlag;
  return (error_flags_ & ErrorFlag::bus_off) != 0 ? Mcp2515State::bus_off
         : (error_flags_ & (ErrorFlag::rx_passive | ErrorFlag::tx_passive)) != 0
             ? Mcp2515State::passive
         : (error_flags_ & ErrorFlag::warning) != 0 ? Mcp2515State::warning
                                                    : Mcp2515State::active;
}

}  // namespace roio

#undef ROIO_MCP2515_MEMBER

#endif
