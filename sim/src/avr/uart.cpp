#include "avr/uart.hpp"

#include <algorithm>
#include <array>

namespace roio::sim {
namespace {

// Registers, from UCSRnA on.
constexpr std::uint16_t control_offset = 1;
constexpr std::uint16_t format_offset = 2;
constexpr std::uint16_t rate_offset = 4;
constexpr std::uint16_t data_offset = 6;
// UCSRnA
constexpr unsigned rxc = 0x80;
constexpr unsigned txc = 0x40;
constexpr unsigned udre = 0x20;
constexpr unsigned dor = 0x08;
constexpr unsigned u2x = 0x02;
constexpr unsigned mpcm = 0x01;
// UCSRnB
constexpr unsigned rxcie_bit = 7;
constexpr unsigned txcie_bit = 6;
constexpr unsigned udrie_bit = 5;
constexpr unsigned rxen = 0x10;
constexpr unsigned txen = 0x08;
constexpr unsigned ucsz2 = 0x04;
// UCSRnC
constexpr unsigned parity = 0x20;
constexpr unsigned two_stop_bits = 0x08;
constexpr unsigned size_shift = 1;
constexpr unsigned format_after_reset = 0x06;

constexpr std::size_t buffered = 2;
constexpr std::array<unsigned, 8> data_bits{5, 6, 7, 8, 8, 8, 8, 9};

}  // namespace

AvrUart::AvrUart(AvrCore& core, std::uint16_t base)
    : core_(core),
      status_(base),
      control_(static_cast<std::uint16_t>(base + control_offset)),
      format_(static_cast<std::uint16_t>(base + format_offset)),
      rate_low_(static_cast<std::uint16_t>(base + rate_offset)),
      data_(static_cast<std::uint16_t>(base + data_offset)),
      received_vector_(core.vector(control_, rxcie_bit)),
      sent_vector_(core.vector(control_, txcie_bit)),
      empty_vector_(core.vector(control_, udrie_bit)) {
  core.take_writes<&AvrUart::write_status>(status_, *this);
  core.take_writes<&AvrUart::write_control>(control_, *this);
  core.take_writes<&AvrUart::write_data>(data_, *this);
  core.take_reads<&AvrUart::read_status>(status_, *this);
  core.take_reads<&AvrUart::read_data>(data_, *this);
  core.avr()->io[AVR_DATA_TO_IO(rate_low_)].w = {};  // plain registers
  reset();
}

// What is on its way to the board goes on; what it had of it is gone.
void AvrUart::reset() {
  core_.data(status_) = udre;
  core_.data(control_) = 0;
  core_.data(format_) = format_after_reset;
  core_.data(rate_low_) = 0;
  core_.data(static_cast<std::uint16_t>(rate_low_ + 1)) = 0;
  shifting_out_ = false;
  next_out_.reset();
  flush();
  // A restart has cleared simavr's timers.
  counters().unheard += shifting_in_ ? 1U : 0U;
  shifting_in_.reset();
  line_busy_ = false;
  core_.cancel<&AvrUart::sent>(*this);
  core_.cancel<&AvrUart::line_event>(*this);
  line_free_ = core_.cycle();
  listen();
}

// --- registers -----------------------------------------------------------------------------------

bool AvrUart::has(std::uint16_t address, unsigned bit) const {
  return (core_.data(address) & bit) != 0;
}

void AvrUart::set_status(unsigned bit, bool on) const {
  std::uint8_t& status = core_.data(status_);
  status = static_cast<std::uint8_t>(on ? status | bit : status & ~bit);
}

AvrCore::Cycle AvrUart::bit_cycles() const {
  const unsigned high = core_.data(static_cast<std::uint16_t>(rate_low_ + 1)) & 0x0FU;
  const AvrCore::Cycle divider = (high << 8 | core_.data(rate_low_)) + 1U;
  return divider * (has(status_, u2x) ? 8U : 16U);
}

unsigned AvrUart::bits_before_stop() const {
  const unsigned size =
      ((core_.data(format_) >> size_shift) & 3U) | (has(control_, ucsz2) ? 4U : 0U);
  return 1 + data_bits.at(size) + (has(format_, parity) ? 1U : 0U);
}

AvrCore::Cycle AvrUart::frame_cycles() const {
  return bit_cycles() * (bits_before_stop() + (has(format_, two_stop_bits) ? 2U : 1U));
}

std::optional<double> AvrUart::bitrate_bps() const {
  return static_cast<double>(AvrCore::clock_hz) / static_cast<double>(bit_cycles());
}

void AvrUart::write_status(std::uint16_t /*address*/, std::uint8_t value) {
  if ((value & txc) != 0) {
    core_.clear(sent_vector_);
  }
  set_status(u2x, (value & u2x) != 0);
  set_status(mpcm, (value & mpcm) != 0);
}

void AvrUart::write_control(std::uint16_t /*address*/, std::uint8_t value) {
  core_.data(control_) = value;
  if ((value & rxen) == 0) {
    flush();
  }
  for (avr_int_vector_t* const vector : {&received_vector_, &sent_vector_, &empty_vector_}) {
    if (avr_regbit_get(core_.avr(), vector->raised) != 0) {
      core_.raise(*vector);
    }
  }
}

std::uint8_t AvrUart::read_status(std::uint16_t /*address*/) {
  set_status(dor, !buffer_.empty() && buffer_.front().after_overrun);
  return core_.data(status_);
}

// RXC and UDRE ask for their interrupt as long as they are set.
void AvrUart::interrupt_entered(const avr_int_vector_t& vector) {
  if (&vector == &received_vector_ && has(status_, rxc)) {
    core_.raise(received_vector_);
  } else if (&vector == &empty_vector_ && has(status_, udre)) {
    core_.raise(empty_vector_);
  }
}

// --- sending -------------------------------------------------------------------------------------

void AvrUart::write_data(std::uint16_t /*address*/, std::uint8_t value) {
  if (!has(control_, txen)) {
    return;
  }
  if (!shifting_out_) {
    start_sending(value, core_.effect_cycle());
    core_.at<&AvrUart::sent>(out_end_, *this);
    // The interrupt for an empty data register goes on: it is empty again at once.
  } else if (!next_out_) {
    next_out_ = value;
    core_.clear(empty_vector_);
  } else {
    ++counters().unsent;
  }
}

void AvrUart::start_sending(std::uint8_t byte, AvrCore::Cycle cycle) {
  shifting_out_ = true;
  out_end_ = cycle + frame_cycles();
  send(out_end_, byte);
}

AvrCore::Cycle AvrUart::sent(AvrCore::Cycle /*when*/) {
  ++counters().sent;
  if (next_out_) {
    start_sending(*next_out_, out_end_);
    next_out_.reset();
    core_.raise(empty_vector_);
    return out_end_;
  }
  shifting_out_ = false;
  core_.raise(sent_vector_);
  return 0;
}

// --- receiving -----------------------------------------------------------------------------------

void AvrUart::receive(std::span<const std::uint8_t> bytes) {
  line_.insert(line_.end(), bytes.begin(), bytes.end());
  listen();
}

/// The next byte begins as soon as the line is free.
void AvrUart::listen() {
  if (!line_busy_ && !line_.empty()) {
    line_busy_ = true;
    core_.at<&AvrUart::line_event>(std::max(core_.cycle() + 1, line_free_), *this);
  }
}

// The beginning of a start bit, and the middle of a stop bit, in turn.
AvrCore::Cycle AvrUart::line_event(AvrCore::Cycle when) {
  if (!shifting_in_) {
    start_bit(when);
    return when + bits_before_stop() * bit_cycles() + bit_cycles() / 2;
  }
  arrived();
  line_busy_ = !line_.empty();
  return line_busy_ ? std::max(line_free_, when + 1) : 0;
}

// 19.7.4: with two frames in the buffer and one in the shift register, the next start bit costs
// the latter.
void AvrUart::start_bit(AvrCore::Cycle when) {
  shifting_in_ = line_.front();
  line_.pop_front();
  line_free_ = when + frame_cycles();
  heard_ = has(control_, rxen);
  if (heard_ && held_) {
    held_.reset();
    overrun_ = true;
    ++counters().overruns;
  }
}

void AvrUart::arrived() {
  const Received received{*shifting_in_, overrun_};
  shifting_in_.reset();
  if (!heard_ || !has(control_, rxen)) {
    ++counters().unheard;
    return;
  }
  overrun_ = false;
  if (buffer_.size() == buffered) {
    held_ = received;
    return;
  }
  buffer_.push_back(received);
  ++counters().received;
  core_.raise(received_vector_);
}

std::uint8_t AvrUart::read_data(std::uint16_t /*address*/) {
  if (buffer_.empty()) {
    return 0;
  }
  const std::uint8_t byte = buffer_.front().byte;
  buffer_.pop_front();
  core_.clear(received_vector_);
  if (held_) {
    buffer_.push_back(*held_);
    held_.reset();
    ++counters().received;
  }
  if (!buffer_.empty()) {
    core_.raise(received_vector_);
  }
  return byte;
}

void AvrUart::flush() {
  counters().unheard += held_ ? 1U : 0U;
  buffer_.clear();
  held_.reset();
  overrun_ = false;
  core_.clear(received_vector_);
}

}  // namespace roio::sim
