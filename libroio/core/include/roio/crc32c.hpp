/// Crc32c: the check of serial records, byte by byte. 1 KiB of table, in flash on an AVR, where a
/// byte takes some 25 cycles. Source: docs/serial-protocol.md "Records"; RFC 3720, B.4.
#ifndef ROIO_CRC32C_HPP
#define ROIO_CRC32C_HPP

#include <stdint.h>

#if defined(__AVR__)
#include <avr/pgmspace.h>
#endif

namespace roio {

namespace detail {

/// The register after `bits` more bits of zero.
constexpr uint32_t crc32c_shift(uint32_t value, uint8_t bits) {
  return bits == 0 ? value
                   : crc32c_shift((value >> 1) ^ ((value & 1U) != 0 ? UINT32_C(0x82F63B78) : 0U),
                                  static_cast<uint8_t>(bits - 1U));
}

#define ROIO_CRC_1(n) crc32c_shift(n, 8)
#define ROIO_CRC_4(n) ROIO_CRC_1(n), ROIO_CRC_1((n) + 1), ROIO_CRC_1((n) + 2), ROIO_CRC_1((n) + 3)
#define ROIO_CRC_16(n) ROIO_CRC_4(n), ROIO_CRC_4((n) + 4), ROIO_CRC_4((n) + 8), ROIO_CRC_4((n) + 12)
#define ROIO_CRC_64(n) \
  ROIO_CRC_16(n), ROIO_CRC_16((n) + 16), ROIO_CRC_16((n) + 32), ROIO_CRC_16((n) + 48)

/// In a class template, so that a header may define it.
template <typename Unused>
struct Crc32cTable {
  static const uint32_t entries[256];
};
template <typename Unused>
const uint32_t Crc32cTable<Unused>::entries[256]
#if defined(__AVR__)
    __attribute__((__progmem__))
#endif
    = {ROIO_CRC_64(0), ROIO_CRC_64(64), ROIO_CRC_64(128), ROIO_CRC_64(192)};

#undef ROIO_CRC_1
#undef ROIO_CRC_4
#undef ROIO_CRC_16
#undef ROIO_CRC_64

inline uint32_t crc32c_entry(uint8_t index) {
#if defined(__AVR__)
  return pgm_read_dword(&Crc32cTable<void>::entries[index]);
#else
  return Crc32cTable<void>::entries[index];
#endif
}

}  // namespace detail

class Crc32c {
 public:
  /// @param start changes the register's first value; 0 is CRC-32C as everybody knows it.
  explicit Crc32c(uint32_t start = 0) : register_(~start) {}

  void add(uint8_t byte) {
    register_ = (register_ >> 8) ^ detail::crc32c_entry(static_cast<uint8_t>(register_ ^ byte));
  }
  uint32_t value() const { return ~register_; }
  /// The value's bytes one after the other, lowest first. Ends the sum.
  uint8_t take_byte() {
    const uint8_t byte = static_cast<uint8_t>(~register_);
    register_ >>= 8;
    return byte;
  }

 private:
  uint32_t register_;
};

}  // namespace roio

#endif
