// As CallTime, with the calls of 2014: available() and read() in the one bracket, write() in the other.
#include <Roio.h>
#include <SPI.h>

Roio roio = Roio(10);

#define FENCE() __asm__ volatile("" ::: "memory")
#define BRACKET(bit, statement) \
  FENCE();                      \
  PORTD |= 1 << (bit);          \
  FENCE();                      \
  statement;                    \
  FENCE();                      \
  PORTD &= ~(1 << (bit));       \
  FENCE()

void setup() {
  DDRD |= 0xF0;
  PORTD |= 1 << 3;  // pull-up
  TIMSK0 = 0;  // Arduino's millis() takes 6 us of a call now and then
  roio.begin(500, 2, 0);
  BRACKET(4, );
}

void loop() {
  if ((PIND & (1 << 3)) == 0) {
    return;  // not now
  }
  uint8_t available = 0;
  BRACKET(4, if ((available = roio.available()) != 0) { roio.read(); });
  if (available == 0) {
    return;
  }
  BRACKET(5, );
  BRACKET(6, roio.write(roio.lastData, roio.lastLength, roio.lastAddress, roio.lastSubnet));
  BRACKET(7, );
}
