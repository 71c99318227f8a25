// A second device on the same SPI, with a pace and a mode of its own: a 74HC595 shift register that
// shows the last byte received.
#include <Roio.h>
#include <SPI.h>

const uint8_t latch = 9;

Roio roio(10);

void show(uint8_t value) {
  SPI.beginTransaction(SPISettings(4000000, LSBFIRST, SPI_MODE3));
  digitalWrite(latch, LOW);
  SPI.transfer(value);
  digitalWrite(latch, HIGH);
  SPI.endTransaction();
}

void setup() {
  pinMode(latch, OUTPUT);
  SPI.begin();
  show(0);
  if (roio.begin(Roio::bitTiming<16000000, 125000>(), Roio::Address{0, 3}) != Roio::Status::ok) {
    show(255);
  }
}

void loop() {
  Roio::Message message;
  if (roio.receive(message) == Roio::Status::ok && message.length() > 0) {
    show(message[0]);
  }
}
