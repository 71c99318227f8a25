// INTn, by its level: each time the function is entered, one pulse on D9, and then the line has to
// be let go. Before: a flag that was set while the interrupt was off, and one that was cleared.
#include "board.hpp"

volatile uint8_t entered;
ISR(INT_VECTOR) {
  ++entered;
  SERVO_PORT |= _BV(SERVO_BIT);
  SERVO_PORT &= ~_BV(SERVO_BIT);
}

static void sense(uint8_t how) {
#if INT_NUMBER < 4
  EICRA = how << (2 * INT_NUMBER);
#else
  EICRB = how << (2 * (INT_NUMBER - 4));
#endif
}

static void edge() {
  while (!(INT_PIN & _BV(INT_BIT))) {
  }
  while (INT_PIN & _BV(INT_BIT)) {
  }
}

int main() {
  uart_begin(1);
  SERVO_DDR |= _BV(SERVO_BIT);
  sense(2);
  EIFR = 0xFF;
  edge();
  uart_put(EIFR);
  EIFR |= _BV(INT_NUMBER);  // by SBI
  uart_put(EIFR);
  EIMSK = _BV(INT_NUMBER);
  sei();
  __builtin_avr_delay_cycles(100);
  uart_put(entered);
  cli();
  EIMSK = 0;
  edge();
  EIMSK = _BV(INT_NUMBER);
  sei();
  __builtin_avr_delay_cycles(100);
  uart_put(entered);
  cli();
  sense(0);
  sei();
  for (;;) {
  }
}
