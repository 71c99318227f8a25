#include "avr/spi.hpp"

#include <array>

namespace roio::sim {
namespace {

constexpr std::uint16_t spcr = 0x4C;
constexpr std::uint16_t spsr = 0x4D;
constexpr std::uint16_t spdr = 0x4E;
constexpr std::uint16_t prr = 0x64;  // PRR0 in the larger ones
// SPCR
constexpr unsigned spie_bit = 7;
constexpr unsigned spe = 0x40;
constexpr unsigned dord = 0x20;
constexpr unsigned mstr = 0x10;
constexpr unsigned mode_shift = 2;
constexpr unsigned rate_mask = 0x03;
// SPSR
constexpr unsigned spif = 0x80;
constexpr unsigned wcol = 0x40;
constexpr unsigned spi2x = 0x01;
// PRR
constexpr unsigned prspi = 0x04;
// Between the end of a byte and the end of the first write that takes effect.
constexpr AvrCore::Cycle cycles_to_next = 2;
// Table 18-5, without SPI2X.
constexpr std::array<unsigned, 4> dividers{4, 16, 64, 128};

}  // namespace

AvrSpi::AvrSpi(AvrCore& core) : core_(core), vector_(core.vector(spcr, spie_bit)) {
  core.take_writes<&AvrSpi::write_control>(spcr, *this);
  core.take_writes<&AvrSpi::write_status>(spsr, *this);
  core.take_writes<&AvrSpi::write_data>(spdr, *this);
  core.take_reads<&AvrSpi::read_status>(spsr, *this);
  core.take_reads<&AvrSpi::read_data>(spdr, *this);
  reset();
}

void AvrSpi::reset() {
  end_.reset();
  free_at_ = 0;
  received_ = 0;
  is_unread_ = false;
  seen_ = 0;
  core_.data(spcr) = 0;
  core_.data(spsr) = 0;
}

unsigned AvrSpi::mode() const {
  return (core_.data(spcr) >> mode_shift) & 3U;
}

std::uint8_t AvrSpi::in_wire_order(std::uint8_t byte) const {
  if ((core_.data(spcr) & dord) == 0) {
    return byte;
  }
  unsigned turned = 0;
  for (unsigned bit = 0; bit < 8; ++bit) {
    turned |= (byte & 1U << bit) != 0 ? 0x80U >> bit : 0U;
  }
  return static_cast<std::uint8_t>(turned);
}

void AvrSpi::write_control(std::uint16_t /*address*/, std::uint8_t value) {
  core_.data(spcr) = value;
  if ((value & spe) == 0) {
    end_.reset();
  }
  if ((core_.data(spsr) & spif) != 0) {
    core_.raise(vector_);
  }
}

void AvrSpi::write_status(std::uint16_t /*address*/, std::uint8_t value) {
  core_.data(spsr) = static_cast<std::uint8_t>((core_.data(spsr) & ~spi2x) | (value & spi2x));
}

// 18.5.2: both flags are cleared by reading SPSR while they are set, and then accessing SPDR.
void AvrSpi::data_accessed() {
  if ((seen_ & spif) != 0) {
    core_.clear(vector_);
  }
  if ((seen_ & wcol) != 0) {
    core_.data(spsr) = static_cast<std::uint8_t>(core_.data(spsr) & ~wcol);
  }
  seen_ = 0;
}

void AvrSpi::violation(const char* what) const {
  if (violated_) {
    violated_(what);
  }
}

void AvrSpi::write_data(std::uint16_t /*address*/, std::uint8_t value) {
  data_accessed();
  if (end_) {
    core_.data(spsr) = static_cast<std::uint8_t>(core_.data(spsr) | wcol);
    return violation("SPDR written while a byte is under way");
  }
  std::uint8_t& control = core_.data(spcr);
  if ((control & spe) != 0 && (control & mstr) != 0 && slave_select_is_low_ &&
      slave_select_is_low_()) {
    control = static_cast<std::uint8_t>(control & ~mstr);  // 18.3.2: another master
    core_.raise(vector_);
  }
  if ((control & spe) == 0 || (control & mstr) == 0 || (core_.data(prr) & prspi) != 0) {
    return;  // as a slave it waits for a clock that never comes
  }
  const bool twice = (core_.data(spsr) & spi2x) != 0;
  const unsigned divider = dividers.at(control & rate_mask) / (twice ? 2U : 1U);
  const bool is_too_early = core_.effect_cycle() < free_at_;
  if (is_too_early) {
    violation("SPDR written in the cycle after a byte: 0 goes out");
  }
  out_ = is_too_early ? std::uint8_t{0} : value;
  end_ = core_.effect_cycle() + AvrCore::Cycle{8} * divider;
  free_at_ = *end_ + cycles_to_next;
  core_.limit(*end_);
}

std::uint8_t AvrSpi::read_status(std::uint16_t /*address*/) {
  seen_ = core_.data(spsr);
  return seen_;
}

// While a byte is under way SPDR still has the one before, which may be what the program wants.
std::uint8_t AvrSpi::read_data(std::uint16_t /*address*/) {
  data_accessed();
  if (end_ && !is_unread_) {
    violation("SPDR read before the byte is there");
  }
  is_unread_ = false;
  return received_;
}

void AvrSpi::finish(std::uint8_t in) {
  received_ = in_wire_order(in);
  is_unread_ = true;
  end_.reset();
  core_.raise(vector_);
}

}  // namespace roio::sim
