// Echo with interrupts off for ever. Pin 5 goes high should they come on.
#include <Roio.h>

#ifndef NODE
#define NODE RoioOn<10> roio
#endif
NODE;
Roio::Message message;

void look() {
  if ((SREG & (1 << SREG_I)) != 0) {
    digitalWrite(5, HIGH);
  }
}

void setup() {
  pinMode(5, OUTPUT);
  noInterrupts();
}

void loop() {
  if (!roio.running()) {
    const Roio::Status status = roio.begin(500, 2, 0);
    look();
    if (status != Roio::Status::ok) {
      return;
    }
  }
  const Roio::Status status = roio.receive(message);
  look();
  if (status == Roio::Status::ok) {
    message.setDestination(message.source());
    while (roio.send(message) == Roio::Status::full) {
      look();
    }
    look();
  }
}
