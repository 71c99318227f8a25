/*
  TwoNodes: two MCP2515 modules on one Arduino talk to each other, for who has one Arduino only.

  Wiring
    both MCP2515 modules    Uno     Leonardo    Mega
    VCC                     5V      5V          5V
    GND                     GND     GND         GND
    SCK                     13      ICSP 3      52
    SI  (MOSI)              11      ICSP 4      51
    SO  (MISO)              12      ICSP 1      50
    CS of the first         10      10          10
    CS of the second        9       9           9
  CANH of one to CANH of the other, CANL to CANL, and the 120 ohm jumper set on both.

  Addresses 0.1 and 0.2, 500 kbit/s; the modules' crystals are named below. Serial at 115200.

  What it does: every second the first sends a number, and the second sends it back. Prints:
    0 came back after 632 us
    1 came back after 632 us
  and what is wrong when it did not.
*/
#include <Roio.h>

// As printed on the modules' crystals: 8.000, on the usual blue module, is 8000000. With the wrong
// one a node runs at another bit rate than its bus, though begin() says ok.
constexpr uint32_t crystal = 16000000;
constexpr uint32_t bitrate = 500000;
constexpr Roio::Address firstAddress = {0, 1};
constexpr Roio::Address secondAddress = {0, 2};
constexpr uint32_t periodMs = 1000;

constexpr uint8_t firstSelect = 10;  // CS
constexpr uint8_t secondSelect = 9;

Roio first(firstSelect);
Roio second(secondSelect);
uint8_t number = 0;
bool underWay = false;
uint32_t sentAtUs = 0;

bool begin(Roio& node, Roio::Address address, const __FlashStringHelper* name) {
  if (node.running()) {
    return true;
  }
  const Roio::Status status = node.begin(Roio::bitTiming<crystal, bitrate>(), address);
  if (status != Roio::Status::ok) {
    Serial.print(name);
    Serial.println(Roio::toString(status));
  }
  return status == Roio::Status::ok;
}

bool beginBoth() {
  const bool hasFirst = begin(first, firstAddress, F("The first MCP2515 (CS on 10): "));
  const bool hasSecond = begin(second, secondAddress, F("The second MCP2515 (CS on 9): "));
  return hasFirst && hasSecond;
}

// Once a second.
void sendNumber() {
  if (!beginBoth()) {
    return;
  }
  if (underWay) {
    Serial.print(number);
    Serial.println(F(" did not come back: check CANH, CANL and the jumpers"));
    ++number;
  }
  sentAtUs = micros();
  underWay = first.send(Roio::Message(secondAddress, &number, sizeof number)) == Roio::Status::ok;
  if (!underWay) {
    Serial.println(F("The first cannot send: check CANH, CANL and the jumpers"));
  }
}

// What the second does: as the sketch Echo.
void sendBack() {
  static Roio::Message message;
  static bool waiting = false;  // for room in the chip; until then the message is kept
  if (!waiting && second.receive(message) == Roio::Status::ok) {
    message.setDestination(message.source());
    waiting = true;
  }
  if (waiting) {
    waiting = second.send(message) != Roio::Status::ok;
  }
}

void receiveNumber() {
  Roio::Message message;
  // Another number than the last one sent comes late, and was reported already.
  if (first.receive(message) == Roio::Status::ok && underWay && message.source() == secondAddress &&
      message[0] == number) {
    underWay = false;
    Serial.print(number);
    Serial.print(F(" came back after "));
    Serial.print(micros() - sentAtUs);
    Serial.println(F(" us"));
    ++number;
  }
}

void setup() {
  Serial.begin(115200);
  // The second chip must not listen while the first one is begun.
  digitalWrite(secondSelect, HIGH);
  pinMode(secondSelect, OUTPUT);
}

void loop() {
  static uint32_t last = 0;
  if (millis() - last >= periodMs) {
    last = millis();
    sendNumber();
  }
  sendBack();
  receiveNumber();
}
