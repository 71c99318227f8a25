// Commands on the UART: 'r' + UBRR (2 bytes) + U2X: another rate. 't': sixteen bytes at once. 'e':
// echo until 0. 'i': echo by interrupts until 0. 's' + n: deaf for n milliseconds, and then says
// what is there, with its flags.
#include "board.hpp"

static uint8_t ring[64];
static volatile uint8_t head;
static volatile uint8_t tail;
static volatile uint8_t over;
ISR(UART_RX_VECTOR) {
  const uint8_t byte = UART_DATA;
  over = byte == 0;
  ring[head++ & 63] = byte;
  UART_B |= UART_UDRIE;
}
ISR(UART_EMPTY_VECTOR) {
  UART_DATA = ring[tail++ & 63];
  if (tail == head) {
    UART_B &= ~UART_UDRIE;
  }
}

static void change_rate() {
  const uint8_t high = uart_get();
  const uint8_t low = uart_get();
  const uint8_t twice = uart_get();
  UART_RATE = high << 8 | low;
  UART_A = twice ? UART_U2X : 0;
}

static void echo_by_interrupts() {
  over = 0;
  UART_B |= UART_RXCIE;
  sei();
  while (!over || head != tail) {
  }
  cli();
  UART_B = UART_RXEN | UART_TXEN;
}

static void be_deaf() {
  for (uint8_t ms = uart_get(); ms > 0; --ms) {
    __builtin_avr_delay_cycles(16000);
  }
  uint8_t status;
  while ((status = UART_A) & UART_RXC) {
    const uint8_t byte = UART_DATA;
    uart_put(status & (UART_RXC | UART_DOR));
    uart_put(byte);
  }
}

int main() {
  uart_begin(1);
  for (;;) {
    switch (uart_get()) {
      case 'r':
        change_rate();
        break;
      case 't':
        UART_A |= UART_TXC;
        for (uint8_t i = 0; i < 16; ++i) {
          uart_put(0x30 + i);
        }
        while (!(UART_A & UART_TXC)) {
        }
        LED_DDR |= _BV(LED_BIT);
        break;
      case 'e':
        for (uint8_t byte = 1; byte != 0;) {
          byte = uart_get();
          uart_put(byte);
        }
        break;
      case 'i':
        echo_by_interrupts();
        break;
      case 's':
        be_deaf();
        break;
      default:
        uart_put('?');
    }
  }
}
