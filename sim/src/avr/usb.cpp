#include "avr/usb.hpp"

#include <algorithm>
#include <utility>

namespace roio::sim {
namespace {

// Registers.
constexpr std::uint16_t usbcon = 0xD8;
constexpr std::uint16_t udcon = 0xE0;
constexpr std::uint16_t udint = 0xE1;
constexpr std::uint16_t udien = 0xE2;
constexpr std::uint16_t udaddr = 0xE3;
constexpr std::uint16_t udfnuml = 0xE4;
constexpr std::uint16_t udfnumh = 0xE5;
constexpr std::uint16_t ueintx = 0xE8;
constexpr std::uint16_t uenum = 0xE9;
constexpr std::uint16_t uerst = 0xEA;
constexpr std::uint16_t ueconx = 0xEB;
constexpr std::uint16_t uecfg0x = 0xEC;
constexpr std::uint16_t uecfg1x = 0xED;
constexpr std::uint16_t uesta0x = 0xEE;
constexpr std::uint16_t ueienx = 0xF0;
constexpr std::uint16_t uedatx = 0xF1;
constexpr std::uint16_t uebclx = 0xF2;
constexpr std::uint16_t uebchx = 0xF3;
constexpr std::uint16_t ueint = 0xF4;
// Where no register is: what the two vectors look at, in place of the many bits that ask for them.
constexpr std::uint16_t vector_enables = 0xE7;
constexpr std::uint8_t general_enable = 0;
constexpr std::uint8_t endpoint_enable = 1;
constexpr std::uint8_t general_raised = 2;
constexpr std::uint8_t endpoint_raised = 3;
constexpr unsigned general_vector = 10;
constexpr unsigned endpoint_vector = 11;

// USBCON, UDCON, UDINT
constexpr unsigned usbe = 0x80;
constexpr unsigned frzclk = 0x20;
constexpr unsigned usbcon_after_reset = frzclk;
constexpr unsigned detach = 0x01;
constexpr unsigned sofi = 0x04;
constexpr unsigned eorsti = 0x08;
// UDADDR
constexpr unsigned adden = 0x80;
// UEINTX
constexpr unsigned txini = 0x01;
constexpr unsigned rxouti = 0x04;
constexpr unsigned rxstpi = 0x08;
constexpr unsigned rwal = 0x20;
constexpr unsigned fifocon = 0x80;
// UECONX
constexpr unsigned epen = 0x01;
constexpr unsigned stallrqc = 0x10;
constexpr unsigned stallrq = 0x20;
// UECFG0X, UECFG1X, UESTA0X
constexpr unsigned epdir_in = 0x01;
constexpr unsigned eptype_shift = 6;
constexpr unsigned alloc = 0x02;
constexpr unsigned epbk_double = 0x04;
constexpr unsigned epsize_shift = 4;
constexpr unsigned cfgok = 0x80;
constexpr std::size_t least_size = 8;

}  // namespace

AvrUsb::AvrUsb(AvrCore& core)
    : core_(core),
      general_vector_(core.vector(general_vector)),
      endpoint_vector_(core.vector(endpoint_vector)) {
  general_vector_.enable = AVR_IO_REGBIT(vector_enables, general_enable);
  general_vector_.raised = AVR_IO_REGBIT(vector_enables, general_raised);
  endpoint_vector_.enable = AVR_IO_REGBIT(vector_enables, endpoint_enable);
  endpoint_vector_.raised = AVR_IO_REGBIT(vector_enables, endpoint_raised);
  for (const std::uint16_t address : {usbcon, udcon}) {
    core.take_writes<&AvrUsb::write_general>(address, *this);
  }
  for (const std::uint16_t address : {udint, udien}) {
    core.take_writes<&AvrUsb::write_device_flags>(address, *this);
  }
  core.take_writes<&AvrUsb::write_reset>(uerst, *this);
  for (const std::uint16_t address : {ueconx, uecfg0x, uecfg1x, uesta0x, ueienx}) {
    core.take_writes<&AvrUsb::write_endpoint>(address, *this);
    core.take_reads<&AvrUsb::read_endpoint>(address, *this);
  }
  for (const std::uint16_t address : {ueintx, uebclx, uebchx, ueint}) {
    core.take_reads<&AvrUsb::read_endpoint>(address, *this);
  }
  core.take_writes<&AvrUsb::write_flags>(ueintx, *this);
  core.take_writes<&AvrUsb::write_data>(uedatx, *this);
  core.take_reads<&AvrUsb::read_data>(uedatx, *this);
  for (const std::uint16_t address : {uenum, udaddr}) {
    core.avr()->io[AVR_DATA_TO_IO(address)].w = {};  // plain registers
  }
  reset();
}

void AvrUsb::reset() {
  endpoints_ = {};
  for (std::uint16_t address = usbcon; address <= ueint; ++address) {
    core_.data(address) = 0;
  }
  core_.data(usbcon) = usbcon_after_reset;
  core_.data(udcon) = detach;
  update_interrupts();
  update_attachment();
}

// --- endpoints -----------------------------------------------------------------------------------

bool AvrUsb::is_control(const Endpoint& endpoint) {
  return (endpoint.type >> eptype_shift) == 0;
}
bool AvrUsb::is_in(const Endpoint& endpoint) {
  return (endpoint.type & epdir_in) != 0;
}
bool AvrUsb::is_enabled(const Endpoint& endpoint) {
  return (endpoint.control & epen) != 0 && (endpoint.memory & alloc) != 0;
}
std::size_t AvrUsb::size_of(const Endpoint& endpoint) {
  return least_size << ((endpoint.memory >> epsize_shift) & 7U);
}
std::size_t AvrUsb::bank_count(const Endpoint& endpoint) {
  return (endpoint.memory & epbk_double) != 0 ? 2 : 1;
}

/// RWAL: the program may read or write one more byte. Not for a control endpoint.
bool AvrUsb::may_access(const Endpoint& endpoint) {
  const Bank& bank = endpoint.banks.at(endpoint.program_at);
  return !is_control(endpoint) && (endpoint.flags & fifocon) != 0 &&
         (is_in(endpoint) ? bank.bytes.size() < size_of(endpoint) : bank.read < bank.bytes.size());
}

AvrUsb::Bank& AvrUsb::bank_to_read(Endpoint& endpoint) {
  return endpoint.banks.at(is_control(endpoint) ? from_host : endpoint.program_at);
}
AvrUsb::Bank& AvrUsb::bank_to_write(Endpoint& endpoint) {
  return endpoint.banks.at(is_control(endpoint) ? to_host : endpoint.program_at);
}

/// The program's bank, if it may have it: a full one of an OUT endpoint, an empty one of an IN.
void AvrUsb::offer_bank(Endpoint& endpoint) {
  const Bank& bank = endpoint.banks.at(endpoint.program_at);
  if (!is_control(endpoint) && bank.full != is_in(endpoint) && (endpoint.flags & fifocon) == 0) {
    endpoint.flags |= static_cast<std::uint8_t>(fifocon | (is_in(endpoint) ? txini : rxouti));
  }
}

void AvrUsb::clear_endpoint(Endpoint& endpoint) {
  endpoint.banks = {};
  endpoint.program_at = 0;
  endpoint.host_at = 0;
  endpoint.flags = is_control(endpoint) ? txini : 0;
  offer_bank(endpoint);
}

/// The program has cleared FIFOCON: it is done with its bank.
void AvrUsb::release_bank(Endpoint& endpoint) {
  Bank& bank = endpoint.banks.at(endpoint.program_at);
  bank.full = is_in(endpoint);
  if (!bank.full) {
    bank = {};
  }
  endpoint.program_at = (endpoint.program_at + 1) % bank_count(endpoint);
  offer_bank(endpoint);
}

/// The host is done with its bank.
void AvrUsb::pass_bank(Endpoint& endpoint) {
  endpoint.host_at = (endpoint.host_at + 1) % bank_count(endpoint);
  offer_bank(endpoint);
}

/// The flags that the program has cleared, and what comes of it.
void AvrUsb::clear_flags(Endpoint& endpoint, std::uint8_t cleared) {
  endpoint.flags &= static_cast<std::uint8_t>(~cleared);
  if (!is_control(endpoint)) {
    if ((cleared & fifocon) != 0) {
      release_bank(endpoint);
    }
    return;
  }
  if ((cleared & (rxstpi | rxouti)) != 0) {
    endpoint.banks[from_host] = {};
  }
  if ((cleared & rxstpi) != 0) {
    endpoint.flags |= txini;  // there is room for the answer, whatever else was written
  } else if ((cleared & txini) != 0) {
    endpoint.banks[to_host].full = true;
  }
}

// --- registers -----------------------------------------------------------------------------------

AvrUsb::Endpoint& AvrUsb::selected() {
  const std::size_t number = core_.data(uenum) & 7U;
  if (number >= endpoint_count) {
    core_.crash("UENUM is 7: there are endpoints 0 to 6");
  }
  return endpoints_.at(std::min(number, endpoint_count - 1));
}

void AvrUsb::write_general(std::uint16_t address, std::uint8_t value) {
  core_.data(address) = value;
  update_attachment();
}

/// UDINT: what is written as 0 is cleared.
void AvrUsb::write_device_flags(std::uint16_t address, std::uint8_t value) {
  core_.data(address) =
      address == udint ? static_cast<std::uint8_t>(core_.data(udint) & value) : value;
  update_interrupts();
}

void AvrUsb::write_reset(std::uint16_t /*address*/, std::uint8_t value) {
  core_.data(uerst) = value;
  for (std::size_t i = 0; i < endpoint_count; ++i) {
    if ((value >> i & 1U) != 0) {
      clear_endpoint(endpoints_.at(i));
    }
  }
  update_interrupts();
}

void AvrUsb::write_endpoint(std::uint16_t address, std::uint8_t value) {
  Endpoint& endpoint = selected();
  switch (address) {
    case ueconx: {
      const bool stalls = (value & stallrqc) == 0 && ((endpoint.control | value) & stallrq) != 0;
      endpoint.control = static_cast<std::uint8_t>((value & epen) | (stalls ? stallrq : 0));
      break;
    }
    case uecfg0x:
      endpoint.type = value;
      break;
    case uecfg1x:
      endpoint.memory = value;
      clear_endpoint(endpoint);
      break;
    case ueienx:
      endpoint.enables = value;
      break;
    default:
      break;  // UESTA0X: nothing that this model sets
  }
  update_interrupts();
}

void AvrUsb::write_flags(std::uint16_t /*address*/, std::uint8_t value) {
  Endpoint& endpoint = selected();
  clear_flags(endpoint, static_cast<std::uint8_t>(endpoint.flags & ~value));
  update_interrupts();
}

void AvrUsb::write_data(std::uint16_t /*address*/, std::uint8_t value) {
  Endpoint& endpoint = selected();
  Bank& bank = bank_to_write(endpoint);
  const bool takes = is_control(endpoint) ? (endpoint.flags & txini) != 0 : may_access(endpoint);
  if (takes && bank.bytes.size() < size_of(endpoint)) {
    bank.bytes.push_back(value);
  } else {
    violation("UEDATX written without room for a byte");
  }
}

std::uint8_t AvrUsb::read_data(std::uint16_t /*address*/) {
  Bank& bank = bank_to_read(selected());
  if (bank.read == bank.bytes.size()) {
    violation("UEDATX read without a byte in it");
    return 0;
  }
  return bank.bytes.at(bank.read++);
}

void AvrUsb::violation(const char* what) const {
  if (violation_listener_) {
    violation_listener_(what);
  }
}

std::uint8_t AvrUsb::read_endpoint(std::uint16_t address) {
  if (address == ueint) {
    return waiting_endpoints();
  }
  Endpoint& endpoint = selected();
  switch (address) {
    case ueintx:
      return static_cast<std::uint8_t>(endpoint.flags | (may_access(endpoint) ? rwal : 0));
    case ueconx:
      return endpoint.control;
    case uecfg0x:
      return endpoint.type;
    case uecfg1x:
      return endpoint.memory;
    case uesta0x:
      return (endpoint.memory & alloc) != 0 ? cfgok : 0;
    case ueienx:
      return endpoint.enables;
    case uebclx:
      return static_cast<std::uint8_t>(bank_to_read(endpoint).bytes.size() -
                                       bank_to_read(endpoint).read);
    default:
      return 0;  // UEBCHX: a bank has 64 bytes here, or 256 that nobody uses
  }
}

// --- the cable -----------------------------------------------------------------------------------

void AvrUsb::update_attachment() {
  const bool attached =
      (core_.data(usbcon) & (usbe | frzclk)) == usbe && (core_.data(udcon) & detach) == 0;
  if (attached != std::exchange(attached_, attached) && attach_listener_) {
    attach_listener_(attached);
  }
}

bool AvrUsb::listens_at(std::uint8_t address) const {
  const unsigned set = core_.data(udaddr);
  return ((set & adden) != 0 ? set & ~adden : 0U) == address;
}

void AvrUsb::bus_reset() {
  endpoints_ = {};
  core_.data(udaddr) = 0;
  core_.data(udint) |= eorsti;
  update_interrupts();
}

void AvrUsb::start_of_frame(std::uint16_t number) {
  core_.data(udfnuml) = static_cast<std::uint8_t>(number);
  core_.data(udfnumh) = static_cast<std::uint8_t>(number >> 8 & 7U);
  core_.data(udint) |= sofi;
  update_interrupts();
}

AvrUsb::Answer AvrUsb::setup(std::span<const std::uint8_t> bytes) {
  Endpoint& endpoint = endpoints_.front();
  if (!is_enabled(endpoint)) {
    return Answer::none;
  }
  endpoint.control &= static_cast<std::uint8_t>(~stallrq);
  endpoint.banks[from_host] = {.bytes = {bytes.begin(), bytes.end()}};
  endpoint.banks[to_host] = {};
  endpoint.flags = rxstpi;
  update_interrupts();
  return Answer::ack;
}

AvrUsb::Answer AvrUsb::out(unsigned number, std::span<const std::uint8_t> bytes) {
  Endpoint& endpoint = endpoints_.at(number);
  if (!is_enabled(endpoint) || (!is_control(endpoint) && is_in(endpoint)) ||
      bytes.size() > size_of(endpoint)) {
    return Answer::none;
  }
  if ((endpoint.control & stallrq) != 0) {
    return Answer::stall;
  }
  const std::size_t at = is_control(endpoint) ? from_host : endpoint.host_at;
  Bank& bank = endpoint.banks.at(at);
  const bool is_free =
      is_control(endpoint) ? (endpoint.flags & (rxstpi | rxouti)) == 0 : !bank.full;
  if (!is_free) {
    return Answer::nak;
  }
  bank = {.bytes = {bytes.begin(), bytes.end()}, .full = true};
  if (is_control(endpoint)) {
    endpoint.flags |= rxouti;
  } else {
    pass_bank(endpoint);
  }
  update_interrupts();
  return Answer::ack;
}

AvrUsb::Answer AvrUsb::in(unsigned number, std::vector<std::uint8_t>& bytes) {
  Endpoint& endpoint = endpoints_.at(number);
  if (!is_enabled(endpoint) || (!is_control(endpoint) && !is_in(endpoint))) {
    return Answer::none;
  }
  if ((endpoint.control & stallrq) != 0) {
    return Answer::stall;
  }
  Bank& bank = endpoint.banks.at(is_control(endpoint) ? to_host : endpoint.host_at);
  if (!bank.full || (endpoint.flags & rxstpi) != 0) {
    return Answer::nak;
  }
  bytes = std::exchange(bank, {}).bytes;
  if (is_control(endpoint)) {
    endpoint.flags |= txini;
  } else {
    pass_bank(endpoint);
  }
  update_interrupts();
  return Answer::ack;
}

// --- interrupts ----------------------------------------------------------------------------------

/// Those that ask for an interrupt, a bit each, as UEINT has them.
std::uint8_t AvrUsb::waiting_endpoints() const {
  unsigned waiting = 0;
  for (std::size_t i = 0; i < endpoint_count; ++i) {
    waiting |= (endpoints_.at(i).flags & endpoints_.at(i).enables) != 0 ? 1U << i : 0U;
  }
  return static_cast<std::uint8_t>(waiting);
}

void AvrUsb::update(avr_int_vector_t& vector, std::uint8_t enable_bit, bool wanted) {
  const unsigned bit = 1U << enable_bit;
  std::uint8_t& enables = core_.data(vector_enables);
  enables = static_cast<std::uint8_t>(wanted ? enables | bit : enables & ~bit);
  if (wanted) {
    core_.raise(vector);
  } else {
    core_.clear(vector);
  }
}

void AvrUsb::update_interrupts() {
  update(general_vector_, general_enable, (core_.data(udint) & core_.data(udien)) != 0);
  update(endpoint_vector_, endpoint_enable, waiting_endpoints() != 0);
}

void AvrUsb::interrupt_entered(const avr_int_vector_t& vector) {
  if (&vector == &general_vector_ || &vector == &endpoint_vector_) {
    update_interrupts();
  }
}

}  // namespace roio::sim
