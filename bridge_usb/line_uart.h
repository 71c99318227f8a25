/// UartLine: the serial line by the processor's UART. Both directions are buffered by interrupts;
/// what overflows is counted. Arduino's Serial is not used: at 1 Mbit/s a byte comes every 160
/// cycles, its interrupt takes half of them and these a quarter.
#ifndef ROIO_BRIDGE_LINE_UART_H
#define ROIO_BRIDGE_LINE_UART_H

#include <Arduino.h>
#include <avr/interrupt.h>

#include "ring.h"

// The UART of the board's USB chip; a Leonardo has only the one on its pins. Bits have the same
// places in all.
#if defined(UCSR0A)
#define ROIO_UCSRA UCSR0A
#define ROIO_UCSRB UCSR0B
#define ROIO_UCSRC UCSR0C
#define ROIO_UBRR UBRR0
#define ROIO_UDR UDR0
#if defined(USART_RX_vect)
#define ROIO_RX_VECTOR USART_RX_vect
#define ROIO_UDRE_VECTOR USART_UDRE_vect
#else
#define ROIO_RX_VECTOR USART0_RX_vect
#define ROIO_UDRE_VECTOR USART0_UDRE_vect
#endif
#else
#define ROIO_UCSRA UCSR1A
#define ROIO_UCSRB UCSR1B
#define ROIO_UCSRC UCSR1C
#define ROIO_UBRR UBRR1
#define ROIO_UDR UDR1
#define ROIO_RX_VECTOR USART1_RX_vect
#define ROIO_UDRE_VECTOR USART1_UDRE_vect
#endif

namespace roio {
namespace bridge {

// Outside the class: an interrupt has no object.
static RingEnds uart_in;
static RingEnds uart_out;
static uint8_t uart_in_bytes[ring_size];
static uint8_t uart_out_bytes[ring_size];
static volatile uint16_t uart_overruns;

class UartLine {
 public:
  static constexpr bool rate_matters = true;
  static constexpr uint8_t pump_below = 0;  ///< Interrupts do that.

  UartLine() : held_(false), idle_(true), overruns_(0) {}

  void begin(uint32_t rate_bps) {
    ROIO_UCSRB = 0;
    ROIO_UCSRC = bit_of(1) | bit_of(2);  // UCSZ: 8 bits, no parity, 1 stop bit
    set_rate(rate_bps);
    ROIO_UCSRB = receive_interrupt | receiver | transmitter;
  }

  /// Of the rates in serial_protocol.hpp, which but for 115200 are exact at 16 MHz.
  void set_rate(uint32_t rate_bps) {
    ROIO_UCSRA = double_speed;
    ROIO_UBRR = static_cast<uint16_t>((F_CPU / 4 / rate_bps - 1) / 2);
  }

  /// What has come, as far as it lies in one piece; consume() what was used of it.
  /// @return how many bytes; 0: none.
  uint8_t peek(const uint8_t*& bytes) const {
    const uint8_t tail = uart_in.tail;
    const uint8_t head = uart_in.head;
    keep_order();
    bytes = uart_in_bytes + tail;
    return static_cast<uint8_t>(head >= tail ? head - tail : 0 - tail);
  }
  void consume(uint8_t count) {
    keep_order();
    uart_in.tail = static_cast<uint8_t>(uart_in.tail + count);
  }

  uint8_t room() const { return uart_out.room(); }
  /// Where records are written, from the first byte that is not committed yet.
  struct Sink {
    uint8_t begin;
    void put(uint8_t offset, uint8_t byte) {
      uart_out_bytes[static_cast<uint8_t>(begin + offset)] = byte;
    }
  };
  Sink sink() const { return Sink{uart_out.head}; }
  void commit(uint8_t count) {
    keep_order();
    uart_out.head = static_cast<uint8_t>(uart_out.head + count);
    if (!held_) {
      send();
    }
  }

  /// While it is held, what is committed waits.
  void hold() { held_ = true; }
  void release() {
    held_ = false;
    if (uart_out.size() != 0) {
      send();
    }
  }

  /// Whether the last bit of all that was committed is on the line.
  bool is_drained() {
    if (uart_out.size() != 0) {
      return false;
    }
    if (!idle_) {
      idle_ = (ROIO_UCSRA & transmit_complete) != 0;
    }
    return idle_;
  }

  /// Bytes that came and were lost, since the start.
  uint32_t overruns() {
    // The interrupt counts in 16 bits, which are added up here.
    const uint8_t before = SREG;
    cli();
    const uint16_t more = uart_overruns;
    uart_overruns = 0;
    SREG = before;
    overruns_ += more;
    return overruns_;
  }

  void pump() {}

 private:
  /// Bytes are in memory before an index says so, and are read after: a compiler does not know that
  /// an interrupt looks.
  static void keep_order() { __asm__ volatile("" ::: "memory"); }

  static constexpr uint8_t bit_of(uint8_t bit) { return static_cast<uint8_t>(1U << bit); }
  static constexpr uint8_t double_speed = 1U << 1;       // U2X
  static constexpr uint8_t transmit_complete = 1U << 6;  // TXC
  static constexpr uint8_t receive_interrupt = 1U << 7;  // RXCIE
  static constexpr uint8_t receiver = 1U << 4;           // RXEN
  static constexpr uint8_t transmitter = 1U << 3;        // TXEN
  static constexpr uint8_t empty_interrupt = 1U << 5;    // UDRIE

  void send() {
    idle_ = false;
    // Cleared by writing a one: from here on it says that nothing is left.
    ROIO_UCSRA = double_speed | transmit_complete;
    ROIO_UCSRB |= empty_interrupt;
  }

  bool held_;
  bool idle_;
  uint32_t overruns_;
};

}  // namespace bridge
}  // namespace roio

// In assembly, for each byte of the line takes one of these, and a compiler saves twice as many
// registers. With the way there and back, 49 cycles for a byte that comes, and 42 for one that goes
// (46 for the last). The ends are head, tail.

ISR(ROIO_RX_VECTOR, ISR_NAKED) {
  __asm__ volatile(
      "push r24\n push r30\n push r31\n in r24, __SREG__\n push r24\n"
      "lds r31, %[ucsra]\n"  // before the byte is read: then it tells of the next
      "lds r24, %[udr]\n"
      "lds r30, %[ends]\n"  // head
      "sbrc r31, 3\n"       // DOR: one or more were lost before this one
      "rjmp 3f\n"
      "1: ldi r31, 0\n subi r30, lo8(-(%[ring]))\n sbci r31, hi8(-(%[ring]))\n"
      "st Z, r24\n"                   // nobody reads it until head has moved
      "subi r30, lo8(%[ring] - 1)\n"  // head + 1
      "lds r24, %[ends]+1\n"          // tail
      "cp r30, r24\n"
      "breq 4f\n"
      "sts %[ends], r30\n"
      "2: pop r24\n out __SREG__, r24\n pop r31\n pop r30\n pop r24\n reti\n"
      "3: rcall 5f\n rjmp 1b\n"
      "4: rcall 5f\n rjmp 2b\n"
      // one more overrun; r24 and r30 stay
      "5: lds r31, %[count]\n inc r31\n sts %[count], r31\n brne 6f\n"
      "lds r31, %[count]+1\n inc r31\n sts %[count]+1, r31\n"
      "6: ret\n"
      :
      : [ucsra] "n"(_SFR_MEM_ADDR(ROIO_UCSRA)), [udr] "n"(_SFR_MEM_ADDR(ROIO_UDR)),
        [ring] "i"(roio::bridge::uart_in_bytes), [ends] "i"(&roio::bridge::uart_in),
        [count] "i"(&roio::bridge::uart_overruns));
}

ISR(ROIO_UDRE_VECTOR, ISR_NAKED) {
  __asm__ volatile(
      "push r30\n push r31\n in r30, __SREG__\n push r30\n"
      "lds r30, %[ends]+1\n"  // tail
      "ldi r31, 0\n subi r30, lo8(-(%[ring]))\n sbci r31, hi8(-(%[ring]))\n"
      "ld r31, Z\n"
      "sts %[udr], r31\n"
      "subi r30, lo8(%[ring] - 1)\n"  // tail + 1
      "sts %[ends]+1, r30\n"
      "lds r31, %[ends]\n"  // head
      "cpse r30, r31\n"
      "rjmp 1f\n"
      "lds r30, %[ucsrb]\n andi r30, 0xDF\n sts %[ucsrb], r30\n"  // all is sent: UDRIE off
      "1: pop r30\n out __SREG__, r30\n pop r31\n pop r30\n reti\n"
      :
      : [ucsrb] "n"(_SFR_MEM_ADDR(ROIO_UCSRB)), [udr] "n"(_SFR_MEM_ADDR(ROIO_UDR)),
        [ring] "i"(roio::bridge::uart_out_bytes), [ends] "i"(&roio::bridge::uart_out));
}

#endif
