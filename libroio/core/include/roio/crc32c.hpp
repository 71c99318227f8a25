/// Crc32c: the check of serial records, byte by byte. 1 KiB of table, in flash on an AVR, where a
/// byte takes 21 cycles. Source: docs/internals/serial-protocol.md "Records"; RFC 3720, B.4.
#ifndef ROIO_CRC32C_HPP
#define ROIO_CRC32C_HPP

#include <stdint.h>

namespace roio {

namespace detail {

/// The register after `bits` more bits of zero.
constexpr uint32_t crc32c_shift(uint32_t value, uint8_t bits) {
  return bits == 0 ? value
                   : crc32c_shift((value >> 1) ^ ((value & 1U) != 0 ? UINT32_C(0x82F63B78) : 0U),
                                  static_cast<uint8_t>(bits - 1U));
}

#define ROIO_CRC_1(n, lane) static_cast<uint8_t>(crc32c_shift(n, 8) >> (8 * (lane)))
#define ROIO_CRC_4(n, lane)                                                  \
  ROIO_CRC_1(n, lane), ROIO_CRC_1((n) + 1, lane), ROIO_CRC_1((n) + 2, lane), \
      ROIO_CRC_1((n) + 3, lane)
#define ROIO_CRC_16(n, lane)                                                 \
  ROIO_CRC_4(n, lane), ROIO_CRC_4((n) + 4, lane), ROIO_CRC_4((n) + 8, lane), \
      ROIO_CRC_4((n) + 12, lane)
#define ROIO_CRC_64(n, lane)                                                      \
  ROIO_CRC_16(n, lane), ROIO_CRC_16((n) + 16, lane), ROIO_CRC_16((n) + 32, lane), \
      ROIO_CRC_16((n) + 48, lane)
#define ROIO_CRC_256(lane) \
  ROIO_CRC_64(0, lane), ROIO_CRC_64(64, lane), ROIO_CRC_64(128, lane), ROIO_CRC_64(192, lane)

/// Four tables, one for each byte of an entry, lowest first: on an AVR the index is then the low
/// byte of an address as it is. In a class template, so that a header may define it.
template <typename Unused>
struct Crc32cTable {
  static const uint8_t lanes[4][256];
};
template <typename Unused>
const uint8_t Crc32cTable<Unused>::lanes[4][256]
#if defined(__AVR__)
    __attribute__((__progmem__, __aligned__(256)))
#endif
    = {{ROIO_CRC_256(0)}, {ROIO_CRC_256(1)}, {ROIO_CRC_256(2)}, {ROIO_CRC_256(3)}};

#undef ROIO_CRC_1
#undef ROIO_CRC_4
#undef ROIO_CRC_16
#undef ROIO_CRC_64
#undef ROIO_CRC_256

#if defined(__AVR__)
/// 21 cycles: a compiler takes ten more for the addresses.
__attribute__((always_inline)) inline uint32_t crc32c_step(uint32_t value, uint8_t byte) {
  __asm__(
      "mov r30, %A0\n eor r30, %1\n ldi r31, hi8(%2)\n"
      "lpm %A0, Z\n eor %A0, %B0\n inc r31\n"
      "lpm %B0, Z\n eor %B0, %C0\n inc r31\n"
      "lpm %C0, Z\n eor %C0, %D0\n inc r31\n"
      "lpm %D0, Z\n"
      : "+r"(value)
      : "r"(byte), "i"(Crc32cTable<void>::lanes)
      : "r30", "r31");
  return value;
}
#else
inline uint32_t crc32c_step(uint32_t value, uint8_t byte) {
  const uint8_t index = static_cast<uint8_t>(value ^ byte);
  const uint8_t(&lanes)[4][256] = Crc32cTable<void>::lanes;
  return (value >> 8) ^ (uint32_t{lanes[3][index]} << 24 | uint32_t{lanes[2][index]} << 16 |
                         uint32_t{lanes[1][index]} << 8 | lanes[0][index]);
}
#endif

}  // namespace detail

class Crc32c {
 public:
  /// @param start changes the register's first value; 0 is CRC-32C as everybody knows it.
  explicit Crc32c(uint32_t start = 0) : register_(~start) {}

  void add(uint8_t byte) { register_ = detail::crc32c_step(register_, byte); }
  uint32_t value() const { return ~register_; }
  /// Whether the last four bytes are the sum, as take_byte() gives it, of all before them: then the
  /// register is the same whatever these are.
  bool ends_with_sum() const { return register_ == UINT32_C(0xB798B438); }
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
