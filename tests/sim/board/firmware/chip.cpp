// Talks to the chip. The button (D4) pressed at the start makes it the one that sends.
#include "board.hpp"

volatile uint8_t line_fell;
ISR(INT_VECTOR) {
  line_fell = 1;
}

static void interrupt_on_falling_edge() {
#if INT_NUMBER < 4
  EICRA = 2 << (2 * INT_NUMBER);
#else
  EICRB = 2 << (2 * (INT_NUMBER - 4));
#endif
  EIMSK = _BV(INT_NUMBER);
  sei();
}

static void chip_begin() {
  chip_reset();
  chip_write(0x2A, 0x00);  // CNF1..3: 500 kbit/s from 16 MHz
  chip_write(0x29, 0xB4);
  chip_write(0x28, 0x02);
  chip_write(0x60, 0x60);  // take anything
  chip_write(0x2B, 0x01);  // interrupt: RXB0 full
  chip_write(0x0F, 0x00);  // normal mode
  while (chip_read(0x0E) & 0xE0) {
  }
}

static void send() {
  static const uint8_t buffer[] = {0x40, 0x24, 0x60, 0x00, 0x00, 0x02, 0xCA, 0xFE};
  chip_select();
  for (uint8_t i = 0; i < sizeof buffer; ++i) {
    spi(buffer[i]);
  }
  chip_deselect();
  chip_select();
  spi(0x81);
  chip_deselect();
}

int main() {
  uart_begin(1);
  BUTTON_PORT |= _BV(BUTTON_BIT);
  spi_begin();
  chip_reset();
  uart_put(chip_read(0x0E));  // CANSTAT
  chip_begin();
  interrupt_on_falling_edge();
  if (!(BUTTON_PIN & _BV(BUTTON_BIT))) {
    __builtin_avr_delay_cycles(16000);
    send();
    for (;;) {
    }
  }
  for (;;) {
    while (!line_fell) {
    }
    line_fell = 0;
    LED_DDR |= _BV(LED_BIT);
    LED_PIN = _BV(LED_BIT);
    chip_select();
    spi(0x90);
    for (uint8_t i = 0; i < 7; ++i) {
      uart_put(spi(0));
    }
    chip_deselect();
  }
}
