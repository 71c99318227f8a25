// Echo as one wrote it for the library of 2014.
#include <Roio.h>
#include <SPI.h>

Roio roio = Roio(10);

void setup() { roio.begin(500, 2, 0); }

void loop() {
  if (roio.available() > 0) {
    roio.read();
    roio.write(roio.lastData, roio.lastLength, roio.lastAddress, roio.lastSubnet);
  }
}
