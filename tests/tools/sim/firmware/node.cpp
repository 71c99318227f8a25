// A node of 500 kbit/s by raw SPI: 0.2, or 0.3 when D4 is low at the start. It prints every message
// to it but those of a flood, and every frame that is no message:
//   'p'                 answers with 'P'
//   'f' n n last        counts; when `last` is not 0, answers with 'F', how many, how many out of
//   turn 'v' us us           a servo on D9 from now on 'o' level           D7 (Leonardo: D13) 'a'
//   answers with 'A' and what A0 measures 'h'                 halts for ever
// Answers go to the sender. D4 pressed: 'c' and how often, to 0.10. On the serial port it repeats a
// line, but for "ping", which sends 'p' to the other node.
#include "board.hpp"

#if defined(__AVR_ATmega328P__)
#define OUT_PORT PORTD
#define OUT_DDR DDRD
#define OUT_BIT 7
#else
#define OUT_PORT LED_PORT
#define OUT_DDR LED_DDR
#define OUT_BIT LED_BIT
#endif

struct Frame {
  uint8_t id[4];  // as the chip has it: SIDH, SIDL, EID8, EID0
  uint8_t length;
  uint8_t data[8];
};

static uint8_t own;
static uint16_t flood;
static uint16_t out_of_turn;
static uint16_t expected;

ISR(TIMER1_COMPA_vect) {
  SERVO_PORT |= _BV(SERVO_BIT);
}
ISR(TIMER1_COMPB_vect) {
  SERVO_PORT &= ~_BV(SERVO_BIT);
}

// --- serial ------------------------------------------------------------------------

static void print(const char* text) {
  while (*text) {
    uart_put(*text++);
  }
}
static void print_hex(uint8_t byte) {
  static const char digits[] = "0123456789ABCDEF";
  uart_put(digits[byte >> 4]);
  uart_put(digits[byte & 15]);
}
static void print_frame(const Frame& frame) {
  for (uint8_t i = 0; i < 4; ++i) {
    print_hex(frame.id[i]);
  }
  uart_put(' ');
  print_hex(frame.length);
  uart_put(' ');
  for (uint8_t i = 0; i < (frame.length & 15); ++i) {
    print_hex(frame.data[i]);
  }
  print("\r\n");
}

// --- the chip ----------------------------------------------------------------------

static void chip_begin() {
  chip_reset();
  chip_write(0x2A, 0x00);  // CNF1..3: 500 kbit/s from 16 MHz
  chip_write(0x29, 0xB4);
  chip_write(0x28, 0x02);
  chip_write(0x60, 0x60);  // RXB0 takes anything
  chip_write(0x0F, 0x00);  // normal mode
  while (chip_read(0x0E) & 0xE0) {
  }
}

static bool receive(Frame& frame) {
  chip_select();
  spi(0xA0);
  const bool full = spi(0) & 1;
  chip_deselect();
  if (!full) {
    return false;
  }
  chip_select();
  spi(0x90);
  uint8_t* const bytes = frame.id;
  for (uint8_t i = 0; i < sizeof frame; ++i) {
    bytes[i] = spi(0);
  }
  chip_deselect();
  return true;
}

static void send(uint8_t to, const uint8_t* data, uint8_t length) {
  while (chip_read(0x30) & 0x08) {
  }
  // prio 1, subnets 0: bit 28, to << 13, own
  const uint32_t id = 0x10000000UL | static_cast<uint32_t>(to) << 13 | own;
  chip_select();
  spi(0x40);
  spi(id >> 21);
  spi((id >> 18 << 5 & 0xE0) | 0x08 | (id >> 16 & 3));
  spi(id >> 8);
  spi(id);
  spi(length);
  for (uint8_t i = 0; i < length; ++i) {
    spi(data[i]);
  }
  chip_deselect();
  chip_select();
  spi(0x81);
  chip_deselect();
}

// --- what it does ------------------------------------------------------------------

static void drive_servo(uint16_t us) {
  SERVO_DDR |= _BV(SERVO_BIT);
  TCCR1A = 0;
  TCCR1B = _BV(WGM12) | _BV(CS11);  // half microseconds
  OCR1A = 40000 - 1;
  OCR1B = 2 * us;
  TIMSK1 = _BV(OCIE1A) | _BV(OCIE1B);
  sei();
}

static uint16_t measure() {
  ADMUX = 0x40 | A0_MUX;
  ADCSRA = _BV(ADEN) | _BV(ADSC) | 7;
  while (ADCSRA & _BV(ADSC)) {
  }
  return ADC;
}

static void count(const uint8_t* data, uint8_t sender) {
  const uint16_t number = data[1] << 8 | data[2];
  ++flood;
  if (number != expected) {
    ++out_of_turn;
  }
  expected = number + 1;
  if (data[3]) {
    const uint8_t answer[] = {'F', static_cast<uint8_t>(flood >> 8), static_cast<uint8_t>(flood),
                              static_cast<uint8_t>(out_of_turn >> 8),
                              static_cast<uint8_t>(out_of_turn)};
    send(sender, answer, sizeof answer);
  }
}

static void obey(const Frame& frame) {
  const uint8_t* const data = frame.data;
  const uint8_t sender = frame.id[3];
  if (data[0] == 'f') {
    count(data, sender);
    return;
  }
  print_frame(frame);
  if (data[0] == 'p') {
    const uint8_t answer[] = {'P'};
    send(sender, answer, sizeof answer);
  } else if (data[0] == 'v') {
    drive_servo(data[1] << 8 | data[2]);
  } else if (data[0] == 'o') {
    OUT_DDR |= _BV(OUT_BIT);
    OUT_PORT = data[1] ? OUT_PORT | _BV(OUT_BIT) : OUT_PORT & ~_BV(OUT_BIT);
  } else if (data[0] == 'a') {
    const uint16_t value = measure();
    const uint8_t answer[] = {'A', static_cast<uint8_t>(value >> 8), static_cast<uint8_t>(value)};
    send(sender, answer, sizeof answer);
  } else if (data[0] == 'h') {
    cli();
    sleep_enable();
    sleep_cpu();
  }
}

// An extended data frame with the own address in bits 20..13: EID 17..16 and 15..8 are bits 17..8.
static bool is_mine(const Frame& frame) {
  const uint8_t sidl = frame.id[1];
  const uint8_t address = (sidl >> 5 << 5) | (sidl & 3) << 3 | frame.id[2] >> 5;
  return (sidl & 0x08) && !(frame.length & 0x40) && address == own;
}

static char line[32];
static uint8_t line_length;

static void serial_byte(char byte) {
  if (byte != '\n') {
    line[line_length] = byte;
    line_length += line_length < sizeof line - 1;
    return;
  }
  line[line_length] = 0;
  if (line_length == 4 && line[0] == 'p' && line[3] == 'g') {
    const uint8_t ping[] = {'p'};
    send(5 - own, ping, sizeof ping);
  } else {
    print("said ");
    print(line);
    print("\r\n");
  }
  line_length = 0;
}

static void look_at_button() {
  static uint8_t was_down;
  static uint8_t clicks;
  const uint8_t is_down = !(BUTTON_PIN & _BV(BUTTON_BIT));
  if (is_down && !was_down) {
    const uint8_t click[] = {'c', ++clicks};
    send(10, click, sizeof click);
  }
  was_down = is_down;
}

int main() {
  uart_begin(16);  // 115200 bit/s, or as near as it comes
  BUTTON_PORT |= _BV(BUTTON_BIT);
  spi_begin();
  own = BUTTON_PIN & _BV(BUTTON_BIT) ? 2 : 3;
  while (!(BUTTON_PIN & _BV(BUTTON_BIT))) {
  }
  chip_begin();
  print(own == 2 ? "node 2\r\n" : "node 3\r\n");
  for (;;) {
    Frame frame;
    if (receive(frame)) {
      if (is_mine(frame)) {
        obey(frame);
      } else if (!(frame.id[1] & 0x08) || (frame.length & 0x40)) {
        print_frame(frame);
      }
    }
    if (UART_A & UART_RXC) {
      serial_byte(UART_DATA);
    }
    look_at_button();
  }
}
