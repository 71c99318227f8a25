/// The SPI of an AVR of 20 MHz at most, as fast as it goes: then SPI has half the processor's
/// clock, and it is known to the cycle when a byte is over. So cycles are counted, 18 from byte to
/// byte, where asking for SPIF takes 21 and more. (Read 17 cycles after the write at the earliest,
/// written again after 18: docs/internals/simulator.md, "Boards".) An interrupt makes it longer,
/// which does no harm.
///
/// spi_start() and spi_put() return while their byte is under way; then comes any of these, or
/// spi_finish(). With spi_exchange() and spi_receive() nothing is under way any more. SPIF is
/// cleared by then: who shares SPI waits for it.
#ifndef ROIO_ARDUINO_SPI_AVR_HPP
#define ROIO_ARDUINO_SPI_AVR_HPP

#include <Arduino.h>

namespace roio {

/// What the functions below call, in one piece because they share it. Each entry may come as soon
/// as 8 cycles after the write to SPDR of the byte that is under way: RET takes 4 and RCALL 3. LPM
/// is there for its 3 cycles in one word; what it reads, into r0, nobody wants.
__attribute__((naked, noinline)) inline void spi_by_counting() {
  __asm__ volatile(
      // r24: the byte.
      ".weak roio_spi_put\n"
      "roio_spi_put:\n"
      "  mov __tmp_reg__, r24\n"
      "  ldi r24, 1\n"
      "  rjmp 2f\n"
      // X: from where. r24: how many.
      ".weak roio_spi_send\n"
      "roio_spi_send:\n"
      "1: ld __tmp_reg__, X+\n"
      "2: rcall 9f\n"  // 7 cycles
      "  nop\n"
      "  out %[spdr], __tmp_reg__\n"
      "  dec r24\n"
      "  breq 9f\n"
      "  lpm\n"
      "  rjmp 1b\n"
      "8: lpm\n"
      "9: ret\n"
      // X: to where, then what is behind. r24: how many.
      ".weak roio_spi_receive\n"
      "roio_spi_receive:\n"
      "  rcall 8b\n"  // 10
      // The same, with nothing under way.
      ".weak roio_spi_receive_more\n"
      "roio_spi_receive_more:\n"
      "  out %[spdr], __zero_reg__\n"
      "  rjmp .+0\n"  // 2
      "  rjmp .+0\n"
      "3: rcall 8b\n"
      "  dec r24\n"
      "  breq 5f\n"
      // In this order: an interrupt between the two may take longer than a byte.
      "  in __tmp_reg__, %[spdr]\n"
      "  out %[spdr], __zero_reg__\n"
      "  st X+, __tmp_reg__\n"
      "  rjmp 3b\n"
      "5: in __tmp_reg__, %[spsr]\n"
      "  in r24, %[spdr]\n"
      "  st X+, r24\n"
      "  ret\n"
      // r24: the byte; then the answer.
      ".weak roio_spi_exchange\n"
      "roio_spi_exchange:\n"
      "  rcall 8b\n"
      "  out %[spdr], r24\n"
      "  rcall 9b\n"
      ".weak roio_spi_finish\n"
      "roio_spi_finish:\n"
      "  rcall 8b\n"
      "  in __tmp_reg__, %[spsr]\n"
      "  in r24, %[spdr]\n"
      "  ret\n"
      :
      : [spdr] "I"(_SFR_IO_ADDR(SPDR)), [spsr] "I"(_SFR_IO_ADDR(SPSR)));
}

// Not templates: there, GCC 5 forgets that a variable has a register.

inline __attribute__((always_inline)) void spi_put(uint8_t byte) {
  register uint8_t value __asm__("r24") = byte;
  __asm__ volatile("%~call roio_spi_put" : "+r"(value) : "i"(spi_by_counting) : "r0");
}

/// @param count 1 or more.
inline __attribute__((always_inline)) void spi_send(const uint8_t* bytes, uint8_t count) {
  register uint8_t left __asm__("r24") = count;
  __asm__ volatile("%~call roio_spi_send"
                   : "+x"(bytes), "+r"(left)
                   : "i"(spi_by_counting)
                   : "r0", "memory");
}

/// @return what came in meanwhile.
inline __attribute__((always_inline)) uint8_t spi_exchange(uint8_t byte) {
  register uint8_t value __asm__("r24") = byte;
  __asm__ volatile("%~call roio_spi_exchange" : "+r"(value) : "i"(spi_by_counting) : "r0");
  return value;
}

/// @param count 1 or more.
/// @return what is behind them.
inline __attribute__((always_inline)) uint8_t* spi_receive(uint8_t* bytes, uint8_t count) {
  register uint8_t left __asm__("r24") = count;
  __asm__ volatile("%~call roio_spi_receive"
                   : "+x"(bytes), "+r"(left)
                   : "i"(spi_by_counting)
                   : "r0", "memory");
  return bytes;
}

/// The same with nothing under way.
inline __attribute__((always_inline)) uint8_t* spi_receive_more(uint8_t* bytes, uint8_t count) {
  register uint8_t left __asm__("r24") = count;
  __asm__ volatile("%~call roio_spi_receive_more"
                   : "+x"(bytes), "+r"(left)
                   : "i"(spi_by_counting)
                   : "r0", "memory");
  return bytes;
}

inline __attribute__((always_inline)) void spi_finish() {
  __asm__ volatile("%~call roio_spi_finish" : : "i"(spi_by_counting) : "r0", "r24");
}

/// The first byte. Who calls this is a function of its own, because of the 8 cycles.
inline __attribute__((always_inline)) void spi_start(uint8_t byte) {
  SPDR = byte;
}

}  // namespace roio

#endif
