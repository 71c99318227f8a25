// Nothing to do: awake, or, with the button pressed, asleep between overflows of timer 0.
#include "board.hpp"

volatile uint16_t overflows;
ISR(TIMER0_OVF_vect) {
  ++overflows;
}

int main() {
  BUTTON_PORT |= _BV(BUTTON_BIT);
  TCCR0B = _BV(CS01) | _BV(CS00);
  TIMSK0 = _BV(TOIE0);
  sei();
  __builtin_avr_delay_cycles(100);
  const bool sleeps = !(BUTTON_PIN & _BV(BUTTON_BIT));
  for (;;) {
    if (sleeps) {
      sleep_mode();
    }
    if (overflows % 100 == 0) {
      LED_DDR |= _BV(LED_BIT);
      LED_PIN = _BV(LED_BIT);
      ++overflows;
    }
  }
}
