/// The registers and pins that the tests' programs use, the same names on all three boards.
#ifndef ROIO_TESTS_BOARDS_FIRMWARE_BOARD_HPP
#define ROIO_TESTS_BOARDS_FIRMWARE_BOARD_HPP

#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/sleep.h>
#include <avr/wdt.h>
#include <stdint.h>

#if defined(__AVR_ATmega328P__)
#define SPI_SS _BV(2)
#define SPI_MOSI _BV(3)
#define SPI_SCK _BV(5)
#define CS_PORT PORTB  // D10
#define CS_DDR DDRB
#define CS_BIT 2
#define LED_PORT PORTB  // D13
#define LED_DDR DDRB
#define LED_PIN PINB
#define LED_BIT 5
#define SERVO_PORT PORTB  // D9
#define SERVO_DDR DDRB
#define SERVO_BIT 1
#define BUTTON_PORT PORTD  // D4
#define BUTTON_PIN PIND
#define BUTTON_BIT 4
#define INT_PIN PIND  // D2
#define INT_BIT 2
#define INT_NUMBER 0
#define INT_VECTOR INT0_vect
#define A0_MUX 0
#elif defined(__AVR_ATmega32U4__)
#define SPI_SS _BV(0)
#define SPI_MOSI _BV(2)
#define SPI_SCK _BV(1)
#define CS_PORT PORTB
#define CS_DDR DDRB
#define CS_BIT 6
#define LED_PORT PORTC
#define LED_DDR DDRC
#define LED_PIN PINC
#define LED_BIT 7
#define SERVO_PORT PORTB
#define SERVO_DDR DDRB
#define SERVO_BIT 5
#define BUTTON_PORT PORTD
#define BUTTON_PIN PIND
#define BUTTON_BIT 4
#define INT_PIN PIND
#define INT_BIT 1
#define INT_NUMBER 1
#define INT_VECTOR INT1_vect
#define A0_MUX 7
#else
#define SPI_SS _BV(0)
#define SPI_MOSI _BV(2)
#define SPI_SCK _BV(1)
#define CS_PORT PORTB
#define CS_DDR DDRB
#define CS_BIT 4
#define LED_PORT PORTB
#define LED_DDR DDRB
#define LED_PIN PINB
#define LED_BIT 7
#define SERVO_PORT PORTH
#define SERVO_DDR DDRH
#define SERVO_BIT 6
#define BUTTON_PORT PORTG
#define BUTTON_PIN PING
#define BUTTON_BIT 5
#define INT_PIN PINE
#define INT_BIT 4
#define INT_NUMBER 4
#define INT_VECTOR INT4_vect
#define A0_MUX 0
#endif

#if defined(__AVR_ATmega32U4__)
#define UART_A UCSR1A
#define UART_B UCSR1B
#define UART_C UCSR1C
#define UART_RATE UBRR1
#define UART_DATA UDR1
#define UART_RX_VECTOR USART1_RX_vect
#define UART_EMPTY_VECTOR USART1_UDRE_vect
#else
#define UART_A UCSR0A
#define UART_B UCSR0B
#define UART_C UCSR0C
#define UART_RATE UBRR0
#define UART_DATA UDR0
#if defined(__AVR_ATmega2560__)
#define UART_RX_VECTOR USART0_RX_vect
#define UART_EMPTY_VECTOR USART0_UDRE_vect
#else
#define UART_RX_VECTOR USART_RX_vect
#define UART_EMPTY_VECTOR USART_UDRE_vect
#endif
#endif
// The same bits in all of them.
#define UART_RXC 0x80
#define UART_TXC 0x40
#define UART_UDRE 0x20
#define UART_DOR 0x08
#define UART_U2X 0x02
#define UART_RXCIE 0x80
#define UART_UDRIE 0x20
#define UART_RXEN 0x10
#define UART_TXEN 0x08

static inline void uart_begin(uint16_t rate_register) {
  UART_A = UART_U2X;
  UART_RATE = rate_register;
  UART_B = UART_RXEN | UART_TXEN;
}
static inline void uart_put(uint8_t byte) {
  while (!(UART_A & UART_UDRE)) {
  }
  UART_DATA = byte;
}
static inline void uart_put16(uint16_t value) {
  uart_put(value >> 8);
  uart_put(value & 0xFF);
}
static inline uint8_t uart_get() {
  while (!(UART_A & UART_RXC)) {
  }
  return UART_DATA;
}

static inline void spi_begin() {
  CS_PORT |= _BV(CS_BIT);
  CS_DDR |= _BV(CS_BIT);
  DDRB |= SPI_SS | SPI_MOSI | SPI_SCK;
  SPCR = _BV(SPE) | _BV(MSTR);
  SPSR = _BV(SPI2X);  // 8 MHz
}
static inline void chip_select() {
  CS_PORT &= ~_BV(CS_BIT);
}
static inline void chip_deselect() {
  CS_PORT |= _BV(CS_BIT);
}
static inline uint8_t spi(uint8_t out) {
  SPDR = out;
  while (!(SPSR & _BV(SPIF))) {
  }
  return SPDR;
}
static inline void chip_write(uint8_t address, uint8_t value) {
  chip_select();
  spi(0x02);
  spi(address);
  spi(value);
  chip_deselect();
}
static inline uint8_t chip_read(uint8_t address) {
  chip_select();
  spi(0x03);
  spi(address);
  const uint8_t value = spi(0);
  chip_deselect();
  return value;
}
static inline void chip_reset() {
  chip_select();
  spi(0xC0);
  chip_deselect();
  __builtin_avr_delay_cycles(16000);
}

#endif
