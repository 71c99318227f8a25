// The calls of 2014, one by one: a letter on the serial port names it, and what it gave is printed.
// And what statuses are in words.
#include <SPI.h>
#include <Roio.h>

Roio roio = Roio(10);

const byte text[12] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
const int rates[] = {2000, 1000, 999, 500, 499, 250, 249, 125, 124, 10, 1, 0};
byte nextRate = 0;
volatile byte somebody = 10;

void show(byte value) { Serial.println(value, HEX); }

void showLast(byte value) {
  Serial.print(value);
  Serial.print(' ');
  Serial.print(roio.lastSubnet);
  Serial.print('.');
  Serial.print(roio.lastAddress);
  for (int i = 0; i < roio.lastLength; i++) {
    Serial.print(' ');
    Serial.print(roio.lastData[i]);
  }
  Serial.println();
}

void setup() {
  Serial.begin(115200);
  roio.begin(500, 2, 0);
}

void loop() {
  if (Serial.available() == 0) {
    return;
  }
  switch (Serial.read()) {
    case 'a': show(roio.available()); break;
    case 's': show(roio.status()); break;
    case 'r': showLast(roio.read()); break;
    case 'e': roio.write(roio.read(), roio.lastAddress, roio.lastSubnet); break;
    case 'b': roio.broadcast(roio.read(), roio.lastSubnet); break;
    case 'w': roio.write(text, sizeof(text), somebody, 0); break;
    case 'x': roio.write(1, 10, 0); break;
    case 'k': roio.begin(rates[nextRate++], 2, 0); break;
    case 'L': roio.showFullBuffers(); break;
    case '0': roio.changeMode(CANMODE_NORMAL); break;
    case '2': roio.changeMode(CANMODE_SLEEP); break;
    case '4': roio.changeMode(CANMODE_LOOP); break;
    case '6': roio.changeMode(CANMODE_LISTEN); break;
    case '8': roio.changeMode(CANMODE_CONFIG); break;
    case '9': roio.changeMode(0xA0); break;
    case 'z': roio.reset(); break;
    case 't':
      for (int i = 0; i < 11; i++) {
        Serial.println(Roio::toString(static_cast<Roio::Status>(i)));
      }
      break;
  }
}
