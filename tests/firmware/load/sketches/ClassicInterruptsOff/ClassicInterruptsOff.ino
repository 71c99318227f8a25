// As InterruptsOff, with the calls of 2014.
#include <Roio.h>
#include <SPI.h>

Roio roio = Roio(10);

void look() {
  if ((SREG & (1 << SREG_I)) != 0) {
    digitalWrite(5, HIGH);
  }
}

void setup() {
  pinMode(5, OUTPUT);
  noInterrupts();
  roio.begin(500, 2, 0);
  look();
}

void loop() {
  if (roio.available() > 0) {
    roio.read();
    look();
    roio.write(roio.lastData, roio.lastLength, roio.lastAddress, roio.lastSubnet);
    look();
  }
}
