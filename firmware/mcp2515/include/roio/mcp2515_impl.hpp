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
constexpr uint16_t pause_us = 200;  ///< 128 clocks (8.1) of any oscillator above 640 kHz.
constexpr uint8_t pauses = 250;     ///< 50 ms: one frame at 5 kbit/s, and 11 bits.
constexpr uint8_t calls_between_checks = 64;
constexpr uint8_t calls_at_most = 192;  ///< Where there is always a frame to be read.

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

// --- single accesses -----------------------------------------------------------------------------

ROIO_MCP2515_MEMBER(void)::open(Transaction& transaction, Instruction instruction,
                                Register address) {
  transaction.exchange(static_cast<uint8_t>(instruction));
  transaction.exchange(static_cast<uint8_t>(address));
}

ROIO_MCP2515_MEMBER(uint8_t)::read_register(Register address) {
  Transaction transaction(port_);
  open(transaction, Instruction::read, address);
  return transaction.exchange(0);
}

ROIO_MCP2515_MEMBER(void)::write_register(Register address, uint8_t value) {
  Transaction transaction(port_);
  open(transaction, Instruction::write, address);
  transaction.exchange(value);
}

ROIO_MCP2515_MEMBER(void)::modify_register(Register address, uint8_t mask, uint8_t value) {
  Transaction transaction(port_);
  open(transaction, Instruction::bit_modify, address);
  transaction.exchange(mask);
  transaction.exchange(value);
}

ROIO_MCP2515_MEMBER(uint8_t)::read_quick_status() {
  Transaction transaction(port_);
  transaction.exchange(static_cast<uint8_t>(Instruction::read_status));
  return transaction.exchange(0);
}

ROIO_MCP2515_MEMBER(void)::read_error_counters(uint8_t& transmit, uint8_t& receive) {
  transmit = read_register(Register::tec);
  receive = read_register(Register::rec);
}

// --- starting ------------------------------------------------------------------------------------

/// Has the chip enter a mode, and sees it there: configuration mode by a reset, which is repeated
/// because one that comes before the oscillator runs is lost.
/// @param control what CANCTRL is to be.
ROIO_MCP2515_MEMBER(bool)::reach(uint8_t control) {
  using mcp2515::Control;
  write_register(Register::canctrl, control);
  uint8_t pauses = mcp2515::pauses;
  do {
    if (control == Control::after_reset) {
      Transaction transaction(port_);
      transaction.exchange(static_cast<uint8_t>(Instruction::reset));
    }
    port_.pause(mcp2515::pause_us);
    if (((read_register(Register::canstat) ^ control) & Control::mode_mask) == 0) {
      return true;
    }
  } while (--pauses != 0);
  return false;
}

/// Writes filters, masks and timing, and reads them back.
/// @return 0 when all are as they have to be.
ROIO_MCP2515_MEMBER(uint8_t)::exchange_setup(const Mcp2515Config& config) {
  constexpr uint8_t block_length = 12;
  constexpr uint8_t blocks_end = 0x30;
  constexpr uint8_t write = static_cast<uint8_t>(Instruction::write);
  constexpr uint8_t read = static_cast<uint8_t>(Instruction::read);
  uint8_t instruction = write;
  for (;;) {
    uint8_t differences = 0;  // what a chip that is written to answers is nothing
    uint8_t address = 0;
    do {
      Transaction transaction(port_);
      open(transaction, static_cast<Instruction>(instruction), static_cast<Register>(address));
      do {
        const uint8_t byte = config[address];
        differences = static_cast<uint8_t>(differences | (transaction.exchange(byte) ^ byte));
        ++address;
      } while ((address & 0x0FU) != block_length);
      address = static_cast<uint8_t>(address + 0x10U - block_length);
    } while (address != blocks_end);
    if (instruction == read) {
      return differences;
    }
    instruction = read;
  }
}

/// Writes what the registers have to be, and reads it back.
ROIO_MCP2515_MEMBER(bool)::configure(const Mcp2515Config& config) {
  using mcp2515::Interrupt;
  using mcp2515::RxControl;
  constexpr uint8_t rx0 = RxControl::by_filters | RxControl::rollover;
  write_register(Register::rxb0ctrl, rx0);
  bool right = (read_register(Register::rxb0ctrl) & RxControl::settings) == rx0;
  for (uint8_t buffer = mcp2515::urgent_buffer; Traits::reports_outcomes && buffer != 0;
       buffer >>= 1) {
    write_register(mcp2515::txbctrl(buffer), order().level_of(buffer));
    right = right && read_register(mcp2515::txbctrl(buffer)) == order().level_of(buffer);
  }
  right = right && exchange_setup(config) == 0;
  if (Port::has_interrupt_line) {
    constexpr uint8_t received = Interrupt::rx0 | Interrupt::rx1;
    write_register(Register::caninte, received);
    right = right && read_register(Register::caninte) == received;
  }
  // The three TXnIF are set and never cleared, so that every READ STATUS shows whether the chip
  // still knows what it was told.
  write_register(Register::canintf, Interrupt::tx_any);
  return right && read_quick_status() == QuickStatus::txif;
}

/// @return whether the chip is there, and in configuration mode.
ROIO_MCP2515_MEMBER(bool)::reset_chip() {
  forget_chip();
  return reach(mcp2515::Control::after_reset);
}

ROIO_MCP2515_MEMBER(Status)::begin(const Mcp2515Config& config) {
  using mcp2515::Control;
  if (!config.timing_is_valid()) {
    return Status::bad_timing;
  }
  const uint8_t mode = config.control() & Control::mode_mask;
  if (mode == static_cast<uint8_t>(mcp2515::Mode::configuration) ||
      (!Traits::reports_outcomes && (config.control() & Control::one_shot) != 0)) {
    return Status::bad_argument;
  }
  return start(config);
}

ROIO_MCP2515_MEMBER(Status)::start(const Mcp2515Config& config) {
  count_what_is_forgotten();
  if (!reset_chip() || !configure(config)) {
    return Status::no_chip;
  }
  control_ = config.control();
  if (!reach(control_)) {
    // Not later either, when nobody expects it any more.
    write_register(Register::canctrl, mcp2515::Control::after_reset);
    return Status::wrong_mode;
  }
  running_ = true;
  return Status::ok;
}

ROIO_MCP2515_MEMBER(Status)::change_mode(mcp2515::Mode mode) {
  using mcp2515::Control;
  if (mode == mcp2515::Mode::configuration) {
    return Status::bad_argument;
  }
  if (!running_) {
    return Status::no_chip;
  }
  const uint8_t control =
      static_cast<uint8_t>((control_ & ~Control::mode_mask) | static_cast<uint8_t>(mode));
  if (!reach(control)) {
    stop();
    return Status::wrong_mode;
  }
  control_ = control;
  return Status::ok;
}

ROIO_MCP2515_MEMBER(Status)::stop() {
  count_what_is_forgotten();
  return reset_chip() ? Status::ok : Status::no_chip;
}

/// Losses that the chip knows of, and frames that nobody has read.
ROIO_MCP2515_MEMBER(void)::count_what_is_forgotten() {
  if (!Traits::diagnoses || !running_) {
    return;
  }
  check_chip();
  if (running_) {
    look();
    counters_.discarded += (quick_ & QuickStatus::rx0) != 0 ? 1 : 0;
    counters_.discarded += (quick_ & QuickStatus::rx1) != 0 ? 1 : 0;
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
  if (!reach(static_cast<uint8_t>(mcp2515::Mode::loopback) | Control::clock_out)) {
    return Status::wrong_mode;
  }
  const uint32_t clocks =
      UINT32_C(1) * mcp2515::clock_frames * mcp2515::clock_frame_bits * config.clocks_per_bit();
  const uint32_t expected_us = clocks / (osc_hz / 1000U) * 1000U;
  load_clock_frames();
  const uint32_t limit_us = mcp2515::clock_timeout_us + mcp2515::slowest_clock_factor * expected_us;
  const uint32_t elapsed_us = time_clock_frames(limit_us);
  // Also ends what may still be under way.
  if (!reach(Control::after_reset) || elapsed_us == 0) {
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
    Transaction transaction(port_);
    transaction.exchange(mcp2515::load_tx(buffer));
    transaction.send(bytes.bytes, sizeof bytes.bytes);
  }
}

/// Sends them, and waits until all are gone.
/// @return how long that took, or some time from limit_us on.
ROIO_MCP2515_MEMBER(uint32_t)::time_clock_frames(uint32_t limit_us) {
  constexpr uint8_t requested =
      QuickStatus::txreq(1) | QuickStatus::txreq(2) | QuickStatus::txreq(4);
  {
    Transaction transaction(port_);
    transaction.exchange(mcp2515::request_to_send(mcp2515::all_buffers));
  }
  const uint32_t start = port_.microseconds();
  uint32_t elapsed_us = 0;
  // A clock that stands still (interrupts are off) must not keep anybody here: a look takes 2 us.
  uint32_t looks = limit_us / 2U;
  do {
    elapsed_us = port_.microseconds() - start;
  } while ((read_quick_status() & requested) != 0 && elapsed_us < limit_us && --looks != 0);
  return elapsed_us;
}

// --- what READ STATUS shows ----------------------------------------------------------------------

/// The three TXnIF are set, and the chip sends nothing but what it was told to. A chip that was
/// reset, and lines stuck at 0 or 1, look different; but for one that is at 1 when all buffers are
/// in use: there is no mode 7, which CANSTAT would have then.
ROIO_MCP2515_MEMBER(bool)::is_plausible(uint8_t quick) {
  using mcp2515::Control;
  if (quick == QuickStatus::everything &&
      (read_register(Register::canstat) & Control::mode_mask) == Control::mode_mask) {
    return false;
  }
  return (quick & static_cast<uint8_t>(~(QuickStatus::any_rx | pending_))) == QuickStatus::txif;
}

/// Reads READ STATUS and takes in what it shows.
ROIO_MCP2515_MEMBER(void)::look() {
  note(read_quick_status(), 2);
}

/// Takes in what READ STATUS showed; nonsense tells of a lost chip.
/// @param tries 2 where nonsense may as well come from a spike on the wires: then once more.
ROIO_MCP2515_MEMBER(void)::note(uint8_t quick, uint8_t tries) {
  while (!is_plausible(quick)) {
    if (--tries == 0) {
      lose_chip();
      return;
    }
    quick = read_quick_status();
  }
  quick_ = quick & QuickStatus::any_rx;
  settle(quick);
}

// --- receiving -----------------------------------------------------------------------------------

/// Whether a frame waits in the chip, as far as is known or can be seen. A line that is low is no
/// frame yet: it may be stuck, or a spike.
/// @param looked whether READ STATUS has been read in this call.
ROIO_MCP2515_MEMBER(bool)::find_received(bool& looked) {
  if (quick_ == 0 && !looked && (!Port::has_interrupt_line || port_.interrupt_line_is_low())) {
    look();
    looked = true;
  }
  return quick_ != 0;
}

/// Takes the older frame out of the chip. There must be one.
/// @return whether it is one for the program.
ROIO_MCP2515_MEMBER(bool)::fetch(Mcp2515Frame& frame) {
  if (!read_rx_buffer((quick_ & QuickStatus::rx0) != 0 && !rx1_is_older_, frame)) {
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
/// With an interrupt line: a buffer that is full holds it low, so a line that is high before the
/// buffer is freed tells of a chip that was reset or fell off; one that is high after it, that
/// nothing more is there, and spares the look.
/// @param first RXB0, else RXB1.
/// @return false: the chip was lost meanwhile, or the line says so; the frame cannot be trusted.
ROIO_MCP2515_MEMBER(bool)::read_rx_buffer(bool first, Mcp2515Frame& frame) {
  bool trusted = true;
  bool looks = true;
  uint8_t quick = 0;
  {
    Transaction transaction(port_);
    transaction.exchange(mcp2515::read_rx(first));
    transaction.receive(frame.bytes, Mcp2515Frame::head_length);
    frame.limit_length();
    // Only as many as the frame has.
    if (frame.length() != 0) {
      transaction.receive(frame.data(), frame.length());
    }
    trusted = !Port::has_interrupt_line || port_.interrupt_line_is_low();
    typename Port::Uninterrupted together(port_);
    transaction.restart();
    looks = !Port::has_interrupt_line || !trusted || port_.interrupt_line_is_low();
    if (looks) {
      transaction.exchange(static_cast<uint8_t>(Instruction::read_status));
      quick = transaction.exchange(0);
    }
  }
  if (looks) {
    // Once only: the order follows from this very look, and that the buffer was freed.
    note(quick, 1);
  } else {
    quick_ = 0;
  }
  rx1_is_older_ = 0;
  if (quick_ != 0) {
    rx1_is_older_ = first ? quick_ & QuickStatus::rx1 : 0;
    // Perhaps both were full for a while, and a third frame was lost: to be looked at soon.
    calls_ |= mcp2515::calls_between_checks;
  }
  trusted = trusted && running_;
  if (!trusted) {
    count(counters_.discarded);
  }
  return trusted;
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
    bool looked = false;
    // As many as the chip holds, so that frames for others keep nobody here.
    for (uint8_t tries = 2; tries != 0 && !received && find_received(looked); --tries) {
      received = fetch(frame);
      looked = true;
    }
    // Without a line it has looked by now, in one way or the other.
    tend(looked || !Port::has_interrupt_line);
  }
  return received ? Status::ok : running_ ? Status::empty : Status::no_chip;
}

ROIO_MCP2515_MEMBER(Status)::poll() {
  if (!running_) {
    return Status::no_chip;
  }
  bool looked = false;
  for (uint8_t i = 0; i < RxQueue + 2U && !rx_queue_.full() && find_received(looked); ++i) {
    if (fetch(rx_queue_.next())) {
      rx_queue_.commit();
    }
    looked = true;
  }
  tend(looked);
  return running_ ? Status::ok : Status::no_chip;
}

// --- sending -------------------------------------------------------------------------------------

ROIO_MCP2515_MEMBER(Status)::send(const Frame& frame, uint8_t token) {
  if (!is_sendable(frame)) {
    return Status::bad_argument;
  }
  return send(mcp2515::to_chip(frame), token);
}

ROIO_MCP2515_MEMBER(Status)::send(const Mcp2515Frame& frame, uint8_t token) {
  if (pending_ != 0) {
    // Only the chip knows whether it has room by now.
    look();
    pump();
  }
  if (!running_) {
    return Status::no_chip;
  }
  if ((control_ & mcp2515::Control::mode_mask) ==
      static_cast<uint8_t>(mcp2515::Mode::listen_only)) {
    return Status::wrong_mode;
  }
  return give_to_chip(frame, token) ? Status::ok : enqueue(frame, token);
}

/// Whether no frame waits that has to go first, and the chip has room; then it is there.
ROIO_MCP2515_MEMBER(bool)::give_to_chip(const Mcp2515Frame& frame, uint8_t token) {
  const bool goes_next =
      tx_queue_.empty() || (is_urgent(frame) && !is_urgent(tx_queue_.front().frame));
  return goes_next && load(frame, token);
}

ROIO_MCP2515_MEMBER(Status)::enqueue(const Mcp2515Frame& frame, uint8_t token) {
  if (tx_queue_.full() || requests_.aborting()) {
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
  tx_queue_[place].keep(token);
  return Status::ok;
}

ROIO_MCP2515_MEMBER(void)::pump() {
  while (running_ && !tx_queue_.empty() &&
         load(tx_queue_.front().frame, tx_queue_.front().kept())) {
    tx_queue_.pop();
  }
}

ROIO_MCP2515_MEMBER(bool)::load(const Mcp2515Frame& frame, uint8_t token) {
  const bool accepts = !requests_.aborting();
  const uint8_t buffer = accepts ? order().choose(is_urgent(frame), pending_) : mcp2515::no_buffer;
  if (buffer == mcp2515::no_buffer) {
    return false;
  }
  const uint8_t length = Traits::all_kinds && frame.is_remote() ? uint8_t{0} : frame.length();
  {
    Transaction transaction(port_);
    if (Traits::back_to_back) {
      // TXBnCTRL is in front of the frame.
      open(transaction, Instruction::write, mcp2515::txbctrl(buffer));
      transaction.exchange(order().level_of(buffer));
    } else {
      transaction.exchange(mcp2515::load_tx(buffer));
    }
    transaction.send(frame.bytes, static_cast<uint8_t>(Mcp2515Frame::head_length + length));
    // By RTS, never by writing TXREQ: errata item 5.
    transaction.restart();
    transaction.exchange(mcp2515::request_to_send(buffer));
  }
  pending_ = static_cast<uint8_t>(pending_ | QuickStatus::txreq(buffer));
  requests_.keep(buffer, token);
  return true;
}

/// Finds the transmissions that have come to their end.
ROIO_MCP2515_MEMBER(void)::settle(uint8_t quick) {
  const uint8_t ended = static_cast<uint8_t>(pending_ & ~quick);
  pending_ &= quick;
  if (!Traits::reports_outcomes || ended != 0) {
    end(ended, TxOutcome::sent);
  }
  if (requests_.aborting() && pending_ == 0) {
    modify_register(Register::canctrl, mcp2515::Control::abort_all, 0);
    requests_.set_aborting(false);
  }
}

/// Reports what became of these requests: bits TXREQ as in READ STATUS.
/// @param outcome unknown, or what there is to be found out more about.
ROIO_MCP2515_MEMBER(void)::end(uint8_t requests, TxOutcome outcome) {
  if (!Traits::reports_outcomes) {
    auto& counter = outcome == TxOutcome::sent ? counters_.sent : counters_.unknown;
    for (; requests != 0; requests &= static_cast<uint8_t>(requests - 1U)) {
      count(counter);
    }
    return;
  }
  uint8_t request = QuickStatus::txreq(mcp2515::urgent_buffer);
  for (uint8_t buffer = mcp2515::urgent_buffer; buffer != 0; buffer >>= 1, request >>= 2) {
    if ((requests & request) != 0) {
      report(requests_.token_of(buffer),
             outcome == TxOutcome::unknown ? outcome : outcome_of(buffer));
    }
  }
}

/// A request ends by success, unless somebody has asked for less.
ROIO_MCP2515_MEMBER(TxOutcome)::outcome_of(uint8_t buffer) {
  using mcp2515::TxControl;
  const bool one_shot = (control_ & mcp2515::Control::one_shot) != 0;
  if (!requests_.aborting() && !one_shot) {
    return TxOutcome::sent;
  }
  const uint8_t control = read_register(mcp2515::txbctrl(buffer));
  if ((control & TxControl::fixed) != order().level_of(buffer)) {
    return TxOutcome::unknown;  // that is no answer of a chip that has ended this request
  }
  if ((control & (TxControl::lost_arbitration | TxControl::error)) != 0 && one_shot) {
    return TxOutcome::failed;
  }
  return (control & TxControl::aborted) != 0 ? TxOutcome::aborted : TxOutcome::sent;
}

ROIO_MCP2515_MEMBER(void)::report(uint8_t token, TxOutcome outcome) {
  if (outcome == TxOutcome::sent) {
    count(counters_.sent);
  } else if (outcome == TxOutcome::unknown) {
    count(counters_.unknown);
  } else {
    count(counters_.not_sent);
  }
  traits_.on_outcome(token, outcome);
}

template <typename Port, uint8_t RxQueue, uint8_t TxQueue, typename Traits>
template <typename T>
void Mcp2515<Port, RxQueue, TxQueue, Traits>::abort() {
  static_assert(T::reports_outcomes, "abort() needs Traits::reports_outcomes");
  while (!tx_queue_.empty()) {
    const uint8_t token = tx_queue_.front().kept();
    tx_queue_.pop();
    report(token, TxOutcome::aborted);
  }
  if (running_ && pending_ != 0) {
    requests_.set_aborting(true);
    modify_register(Register::canctrl, mcp2515::Control::abort_all, mcp2515::Control::abort_all);
  }
}

// --- looking after the chip ----------------------------------------------------------------------

/// What is done at the end of every call that has time.
/// @param looked whether READ STATUS has been read in this call.
ROIO_MCP2515_MEMBER(void)::tend(bool looked) {
  ++calls_;
  // When there is time, and at the latest when there has been none for long.
  const bool check =
      calls_ >= mcp2515::calls_between_checks && (quick_ == 0 || calls_ >= mcp2515::calls_at_most);
  // A line may keep silent for ever, and poll() alone does not receive.
  const bool must_look = check || !tx_queue_.empty() || requests_.aborting() ||
                         (Traits::reports_outcomes && pending_ != 0);
  if (must_look && !looked && running_) {
    look();
  }
  if (!tx_queue_.empty()) {
    pump();
  }
  if (check && running_) {
    calls_ = 0;
    check_chip();
  }
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
  if (running_) {
    count(counters_.chip_losses);
  }
  forget_chip();
}

/// The chip has no memory of what it was told. What it had to send may or may not have gone out.
ROIO_MCP2515_MEMBER(void)::forget_chip() {
  running_ = false;
  quick_ = 0;
  rx1_is_older_ = 0;
  requests_.set_aborting(false);
  error_flags_ = 0;
  end(pending_, TxOutcome::unknown);
  pending_ = 0;
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

#undef ROIO_MCP2515_MEMBER

#endif
