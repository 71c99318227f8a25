// How long a byte of SPI takes, for each divider; and what the flags do. One line of numbers, 16
// bits each, on the UART.
#include "board.hpp"

// Whether SPIF is there `Cycles` after the end of the write.
template <uint16_t Cycles>
__attribute__((noinline)) uint8_t over_after() {
  SPDR = 0;
  __builtin_avr_delay_cycles(Cycles);
  const uint8_t status = SPSR;
  while (!(SPSR & _BV(SPIF))) {
  }
  (void)SPDR;
  return status >> 7;
}

__attribute__((noinline)) uint16_t poll() {
  TCNT1 = 0;
  SPDR = 0x55;
  while (!(SPSR & _BV(SPIF))) {
  }
  const uint16_t cycles = TCNT1;
  (void)SPDR;
  return cycles;
}

template <uint16_t Divider>
void measure(uint8_t control, uint8_t status) {
  SPCR = _BV(SPE) | _BV(MSTR) | control;
  SPSR = status;
  uart_put16(over_after<8 * Divider - 1>());
  uart_put16(over_after<8 * Divider>());
  uart_put16(poll());
}

// What comes of it when the next byte is written, and the last one read, so many cycles after a
// write, at half the clock: Cycles between the two instructions.
template <uint16_t Cycles>
__attribute__((noinline)) void write_after() {
  uint8_t second = 0xA2;
  asm volatile("" : "+r"(second));  // in a register now, and not only when it is needed
  SPDR = 0xA1;
  __builtin_avr_delay_cycles(Cycles);
  SPDR = second;
  __builtin_avr_delay_cycles(40);
  (void)SPSR;
  (void)SPDR;
}

template <uint16_t Cycles>
__attribute__((noinline)) uint8_t read_after() {
  SPDR = 0xA3;
  __builtin_avr_delay_cycles(40);
  (void)SPSR;
  (void)SPDR;
  SPDR = 0xA4;
  __builtin_avr_delay_cycles(Cycles);
  const uint8_t answer = SPDR;
  __builtin_avr_delay_cycles(40);
  (void)SPSR;
  (void)SPDR;
  return answer;
}

volatile uint8_t interrupts;
ISR(SPI_STC_vect) {
  ++interrupts;
}

int main() {
  uart_begin(1);
  TCCR1A = 0;
  TCCR1B = _BV(CS10);
  spi_begin();
  measure<2>(0, _BV(SPI2X));
  measure<4>(0, 0);
  measure<8>(_BV(SPR0), _BV(SPI2X));
  measure<16>(_BV(SPR0), 0);
  measure<32>(_BV(SPR1), _BV(SPI2X));
  measure<64>(_BV(SPR1), 0);
  measure<128>(_BV(SPR1) | _BV(SPR0), 0);

  // A byte written while one is under way is lost, and WCOL tells.
  SPCR = _BV(SPE) | _BV(MSTR) | _BV(SPR0);
  SPSR = 0;
  SPDR = 0x11;
  SPDR = 0x22;
  while (!(SPSR & _BV(SPIF))) {
  }
  uart_put16(SPSR);
  (void)SPDR;
  uart_put16(SPSR);
  // SPIF stays until SPSR and then SPDR are accessed.
  SPDR = 0x33;
  __builtin_avr_delay_cycles(200);
  (void)SPDR;
  uart_put16(SPSR);
  (void)SPDR;
  uart_put16(SPSR);
  // The interrupt clears it.
  SPCR |= _BV(SPIE);
  sei();
  SPDR = 0x44;
  __builtin_avr_delay_cycles(200);
  uart_put16(interrupts);
  uart_put16(SPSR);
  SPCR = _BV(SPE) | _BV(MSTR);
  SPSR = _BV(SPI2X);
  cli();
  SPDR = 0xA0;
  __builtin_avr_delay_cycles(40);
  write_after<15>();
  write_after<16>();
  write_after<17>();
  uart_put16(read_after<15>());
  uart_put16(read_after<16>());
  sei();
  for (;;) {
  }
}
