/*
  Broadcast: says something to everybody every second, and prints what others say to everybody.

  Wiring
    MCP2515 module    Uno    Leonardo    Mega
    VCC               5V     5V          5V
    GND               GND    GND         GND
    SCK               13     ICSP 3      52
    SI  (MOSI)        11     ICSP 4      51
    SO  (MISO)        12     ICSP 1      50
    CS                10     10          10
  Between CANH and CANL belong 120 ohms at each end of the bus.

  Address 0.4 (each board needs another one), 500 kbit/s; the module's crystal is named below.
  Serial at 115200.

  What it does: sends one byte to 0.*, which counts: 0, 1, 2... And what it prints beside a board
  0.5 with the same sketch:
    This is 0.4
    0.5 says 12
    0.5 says 13
*/
#include <Roio.h>

// As printed on the module's crystal: 8.000, on the usual blue module, is 8000000. With the wrong
// one the node runs at another bit rate than its bus, though begin() says ok.
constexpr uint32_t crystal = 16000000;
constexpr uint32_t bitrate = 500000;
constexpr Roio::Address own = {0, 4};
constexpr uint32_t periodMs = 1000;

RoioOn<10> roio;  // CS
uint8_t count = 0;

Roio::Status begin() {
  return roio.begin<crystal, bitrate>(own);
}

void print(Roio::Address address) {
  Serial.print(address.subnet);
  Serial.print('.');
  Serial.print(address.node);
}

void print(const Roio::Message& message) {
  print(message.source());
  Serial.print(F(" says"));
  for (uint8_t i = 0; i < message.length(); ++i) {
    Serial.print(' ');
    Serial.print(message[i]);
  }
  Serial.println();
}

// Printing takes longer than messages do on the bus: says so when some were lost meanwhile.
void printLosses() {
  static uint16_t told = 0;
  if (roio.counters().overflows != told) {
    told = roio.counters().overflows;
    Serial.print(F("Messages came too fast, times: "));
    Serial.println(told);
  }
}

void setup() {
  Serial.begin(115200);
  Serial.print(F("This is "));
  print(own);
  Serial.println();
  const Roio::Status status = begin();
  if (status != Roio::Status::ok) {
    Serial.print(F("Cannot begin, "));
    Serial.print(Roio::toString(status));
    Serial.println(F(": check the wiring and the CS pin"));
  }
}

void loop() {
  // When the chip was not there, or has been without power.
  if (!roio.running() && begin() != Roio::Status::ok) {
    return;
  }
  Roio::Message message;
  if (roio.receive(message) == Roio::Status::ok && message.isBroadcast()) {
    print(message);
  }
  printLosses();

  static uint32_t last = 0;
  // Not ok: the bus is busy, or not there. The next loop() tries again.
  if (millis() - last >= periodMs &&
      roio.send(Roio::Message(Roio::everybody(0), &count, sizeof count)) == Roio::Status::ok) {
    last = millis();
    ++count;
  }
}
