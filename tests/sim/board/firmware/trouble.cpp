// One way to an end for each byte that comes in.
#include "board.hpp"

int main() {
  uart_begin(1);
  LED_DDR |= _BV(LED_BIT);  // it has begun
  switch (uart_get()) {
    case 'i':
      asm volatile(".word 0x0001");  // no instruction
      break;
    case 'f':
      asm volatile("ldi r30, 0x00\n ldi r31, 0x30\n ijmp");  // far behind the program
      break;
    case 's':
      cli();
      sleep_enable();
      sleep_cpu();
      break;
    case 'm':
      *reinterpret_cast<volatile uint8_t*>(0x7000) = 1;  // no memory there
      break;
    case 'w':
      wdt_enable(WDTO_15MS);
      for (;;) {
      }
    default:  // falls off the end
      break;
  }
  return 0;
}
