// Echo on an SPI that it shares with two more devices: loop() sends C3 3C to the one on pin 8, in
// another mode and at another rate, and an interrupt, the falling edge of pin 3, sends A5 5A to the one
// on pin 9.
#include <Roio.h>
#include <SPI.h>

#ifndef NODE
#define NODE RoioOn<10> roio
#endif
NODE;
Roio::Message message;
bool waiting;

void useByInterrupt() {
  SPI.beginTransaction(SPISettings(2000000, MSBFIRST, SPI_MODE1));
  digitalWrite(9, LOW);
  SPI.transfer(0xA5);
  SPI.transfer(0x5A);
  digitalWrite(9, HIGH);
  SPI.endTransaction();
}

void useByLoop() {
  SPI.beginTransaction(SPISettings(1000000, LSBFIRST, SPI_MODE3));
  digitalWrite(8, LOW);
  SPI.transfer(0xC3);
  SPI.transfer(0x3C);
  digitalWrite(8, HIGH);
  SPI.endTransaction();
}

void setup() {
  for (uint8_t pin = 8; pin <= 9; ++pin) {
    digitalWrite(pin, HIGH);
    pinMode(pin, OUTPUT);
  }
  SPI.begin();
  SPI.usingInterrupt(digitalPinToInterrupt(3));
  pinMode(3, INPUT_PULLUP);
  attachInterrupt(digitalPinToInterrupt(3), useByInterrupt, FALLING);
}

void loop() {
  if (!roio.running() && roio.begin(500, 2, 0) != Roio::Status::ok) {
    return;
  }
  useByLoop();
  if (!waiting && roio.receive(message) == Roio::Status::ok) {
    message.setDestination(message.source());
    waiting = true;
  }
  if (waiting) {
    waiting = roio.send(message) != Roio::Status::ok;
  }
}
