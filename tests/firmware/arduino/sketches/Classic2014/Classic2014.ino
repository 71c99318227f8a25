// As one wrote for the library of 2014: it has to compile as it is, whatever the library becomes.
#include <SPI.h>
#include <Roio.h>

Roio roio = Roio(10);

byte text[8] = {'r', 'o', 'i', 'o', 0, 1, 2, 3};
int rates[] = {1000, 500, 250, 125, 10};

void tryEachRate() {
  for (int i = 0; i < 5; i++) {
    roio.begin(rates[i], 2, 0);
  }
  roio.begin(1000, 2, 0);
  roio.begin(250, 2, 0);
  roio.begin(125, 2, 0);
  roio.begin(10, 2, 0);
}

void setup() {
  Serial.begin(9600);
  tryEachRate();
  roio.begin(500, 2, 0);
  roio.changeMode(0);
}

void loop() {
  if (roio.available() > 0) {
    byte first = roio.read();
    Serial.print(roio.lastSubnet);
    Serial.print('.');
    Serial.print(roio.lastAddress);
    if (roio.isBroadcast()) {
      Serial.print(" to all");
    }
    for (int i = 0; i < roio.lastLength; i++) {
      Serial.print(' ');
      Serial.print(roio.lastData[i]);
    }
    Serial.println();

    roio.write(first, roio.lastAddress, roio.lastSubnet);
    roio.write(roio.lastData, roio.lastLength, roio.lastAddress, roio.lastSubnet);
    roio.write(45, 25, 10);
    roio.write(text, 8, 25, 10);
    roio.broadcast(first, 0);
    roio.broadcast(1, 10);
    roio.broadcast(text, sizeof(text), 0);
  }
  if ((roio.status() & 0x04) != 0) {
    delay(1);  // the last one is still to be sent
  }
  if (Serial.read() == 'r') {
    roio.reset();
    roio.begin(500, 2, 0);
  }
}
