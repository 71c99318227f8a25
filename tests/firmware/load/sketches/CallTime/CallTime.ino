// How long receive() and send() take: pin 4 is high as long as receive() runs, pin 6 as long as
// send() does; a pulse on pin 5 or 7 then says that it returned ok. The very first pulse of pin 4 has
// nothing in it: the cost of the bracket. Uno only. Sends each message back; does nothing
// while pin 3 is low.
#include <Roio.h>

#ifndef NODE
#define NODE RoioOn<10> roio
#endif
NODE;
Roio::Message message;

// What lies on one side of it in the source stays there.
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
  const Roio::Status status = roio.begin(500, 2, 0);
  BRACKET(4, );
  if (status != Roio::Status::ok) {
    for (;;) {
    }
  }
}

void loop() {
  if ((PIND & (1 << 3)) == 0) {
    return;  // not now
  }
  Roio::Status status;
  BRACKET(4, status = roio.receive(message));
  if (status != Roio::Status::ok) {
    return;
  }
  BRACKET(5, );
  message.setDestination(message.source());
  BRACKET(6, status = roio.send(message));
  if (status == Roio::Status::ok) {
    BRACKET(7, );
  }
}
