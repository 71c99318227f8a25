// Pulses, a button with its pull-up, a potentiometer, timers.
#include "board.hpp"

static uint16_t convert() {
  ADCSRA |= _BV(ADSC);
  while (ADCSRA & _BV(ADSC)) {
  }
  return ADC;
}

volatile uint8_t before;
volatile uint8_t within;
ISR(TIMER1_COMPA_vect, ISR_NAKED) {
  asm volatile("lds r25, %0\n sts within, r25\n reti" ::"i"(_SFR_MEM_ADDR(TCNT1L)));
}

// From SEI, with an interrupt that waits, to the first instruction of its function.
__attribute__((noinline)) static uint8_t response() {
  OCR1A = 100;
  TCNT1 = 0;
  TIFR1 = 0xFF;
  TIMSK1 = _BV(OCIE1A);
  __builtin_avr_delay_cycles(120);
  asm volatile(
      "lds r24, %0\n sts before, r24\n lds r24, %0\n sei\n nop\n cli\n sts before, r24\n" ::"i"(
          _SFR_MEM_ADDR(TCNT1L))
      : "r24", "r25");
  TIMSK1 = 0;
  return within - before;
}

volatile uint16_t overflows;
ISR(TIMER0_OVF_vect) {
  ++overflows;
}

int main() {
  uart_begin(1);
  LED_DDR |= _BV(LED_BIT);
  SERVO_DDR |= _BV(SERVO_BIT);
  BUTTON_PORT |= _BV(BUTTON_BIT);
  TCCR1A = 0;
  TCCR1B = _BV(CS10);

  // 1500 us and 544 us, to the cycle: the time between the ends of two instructions.
  const uint8_t high = SERVO_PORT | _BV(SERVO_BIT);
  const uint8_t low = SERVO_PORT & ~_BV(SERVO_BIT);
  SERVO_PORT = high;
  __builtin_avr_delay_cycles(24000 - (_SFR_MEM_ADDR(SERVO_PORT) < 0x60 ? 1 : 2));
  SERVO_PORT = low;
  __builtin_avr_delay_cycles(16000);

  ADMUX = _BV(REFS0) | A0_MUX;
  ADCSRA = _BV(ADEN) | 7;
  convert();
  TCNT1 = 0;
  const uint16_t value = convert();
  uart_put16(TCNT1);
  uart_put16(value);

  uart_put16(response());

  // As Arduino's millis(): an overflow of timer 0 each 1024 us.
  TCCR0A = 0;
  TCCR0B = _BV(CS01) | _BV(CS00);
  TCNT0 = 0;
  TIMSK0 = _BV(TOIE0);
  sei();
  __builtin_avr_delay_cycles(160000);
  cli();
  uart_put16(overflows);
  uart_put16(TCNT0);
  sei();

  // SBI toggles one pin.
  LED_PORT |= _BV(LED_BIT);
  for (;;) {
    if (BUTTON_PIN & _BV(BUTTON_BIT)) {
      LED_PORT &= ~_BV(LED_BIT);
    } else {
      LED_PORT |= _BV(LED_BIT);
    }
    SERVO_PORT = SERVO_PORT;  // a write to the port must not move the inputs
    BUTTON_PORT = BUTTON_PORT;
  }
}
