/*
  Echo: sends each message back to whoever sent it. The smallest whole node; try it with
  roio-cli, or from a second Arduino.

  Wiring
    MCP2515 module    Uno    Leonardo    Mega
    VCC               5V     5V          5V
    GND               GND    GND         GND
    SCK               13     ICSP 3      52
    SI  (MOSI)        11     ICSP 4      51
    SO  (MISO)        12     ICSP 1      50
    CS                10     10          10
  Between CANH and CANL belong 120 ohms at each end of the bus.

  Address 0.2, 500 kbit/s; the module's crystal is named below.

  What it does: of each message to 0.2 and to 0.*, length, bytes and priority come back.
*/
#include <Roio.h>

// As printed on the module's crystal: 8.000, on the usual blue module, is 8000000. With the wrong
// one the node runs at another bit rate than its bus, though begin() says ok.
constexpr uint32_t crystal = 16000000;
constexpr uint32_t bitrate = 500000;
constexpr Roio::FixedAddress<0, 2> own{};

RoioOn<10> roio;  // CS
Roio::Message message;
bool waiting;  // for room in the chip: until then the message is kept

bool begin() {
  return roio.begin<crystal, bitrate>(own) == Roio::Status::ok;
}

void setup() {}

void loop() {
  // The first time, and again after the chip was without power.
  if (!roio.running() && !begin()) {
    return;
  }
  if (!waiting) {
    if (roio.receive(message) != Roio::Status::ok) {
      return;
    }
    message.setDestination(message.source());
  }
  waiting = roio.send(message) != Roio::Status::ok;
}
