/*
  Diagnostics: says every second what is wrong with this node and its bus, and what to do.

  Wiring
    MCP2515 module    Uno    Leonardo    Mega
    VCC               5V     5V          5V
    GND               GND    GND         GND
    SCK               13     ICSP 3      52
    SI  (MOSI)        11     ICSP 4      51
    SO  (MISO)        12     ICSP 1      50
    CS                10     10          10
    INT               2      2           2
  It works without INT, and says so. Between CANH and CANL belong 120 ohms at each end of the bus: 60 ohms in all, with power off.

  Address 0.250, 500 kbit/s; the module's crystal is named below. Serial at 115200.

  What it does: sends a message a second to itself, 0.250, which others acknowledge and ignore;
  so there must be a second node on the bus, with any sketch. Prints each second one of these, with
  what to look at:
    NO CHIP  WRONG CRYSTAL  BUS STUCK  BUS-OFF  NO ACKNOWLEDGEMENT  ERRORS  ALL IS WELL
  and, when the chip works, what was counted since the start.
*/
#include <Roio.h>

// As printed on the module's crystal: 8.000, on the usual blue module, is 8000000. With the wrong
// one the node runs at another bit rate than its bus, though begin() says ok.
constexpr uint32_t crystal = 16000000;
constexpr uint32_t bitrate = 500000;
constexpr Roio::Address own = {0, 250};
constexpr uint32_t periodMs = 1000;
constexpr uint8_t passiveLimit = 128;  // of an error counter, from which a node is error-passive

struct Options : RoioOptions {
  static constexpr bool diagnoses = true;  // errors on the bus are counted
};

RoioOn<10, 2, Options> roio;  // CS, INT

// --- starting ------------------------------------------------------------------------------------

void printStartTrouble(Roio::Status status, uint32_t measuredHz) {
  switch (status) {
    case Roio::Status::wrong_clock:
      Serial.print(F("WRONG CRYSTAL: about "));
      Serial.print((measuredHz + 500000) / 1000000);
      Serial.print(F(" MHz, and this sketch says "));
      Serial.print(crystal / 1000000);
      Serial.println(F(". Change the line with crystal."));
      break;
    case Roio::Status::wrong_mode:
      Serial.println(F("BUS STUCK: it is never quiet. Does CANH or CANL touch 5V or GND?"));
      break;
    default:
      Serial.println(F("NO CHIP: check CS, SCK, SI and SO (swapped?), 5V and GND."));
      break;
  }
}

bool begin() {
  const Roio::BitTiming timing = Roio::bitTiming<crystal, bitrate>();
  uint32_t measuredHz = 0;
  Roio::Status status = roio.checkClock(timing, crystal, measuredHz);
  if (status == Roio::Status::ok) {
    status = roio.begin(timing, own);
  }
  if (status != Roio::Status::ok) {
    printStartTrouble(status, measuredHz);
  }
  return status == Roio::Status::ok;
}

// --- once a second -------------------------------------------------------------------------------

// What has happened since the last report.
void printVerdict(bool wasSent, bool wasBusOff, bool hadErrors, bool hearsNonsense) {
  if (wasBusOff) {
    Serial.println(F("BUS-OFF: what it sends is not what is on the bus. Do CANH and CANL touch?"));
  } else if (!wasSent && hearsNonsense) {
    Serial.println(F("BUS STUCK, OR OTHER RATE: it hears nonsense. Do all nodes run at one rate?"));
  } else if (!wasSent) {
    Serial.println(F("NO ACKNOWLEDGEMENT: is another node on? At the same rate? CANH to CANH?"));
  } else if (hadErrors) {
    Serial.println(F("ERRORS: but it works. 120 ohms at both ends? All at one rate? A loose cable?"));
  } else {
    Serial.println(F("ALL IS WELL."));
  }
}

void printNumber(const __FlashStringHelper* name, uint16_t number) {
  Serial.print(name);
  Serial.print(number);
}

void printState() {
  switch (roio.state()) {
    case Roio::State::active:
      Serial.print(F("error-active"));
      break;
    case Roio::State::warning:
      Serial.print(F("error-active, with a warning"));
      break;
    case Roio::State::passive:
      Serial.print(F("error-passive"));
      break;
    case Roio::State::bus_off:
      Serial.print(F("bus-off"));
      break;
  }
}

// The error counters fall by one with each message that goes well: it may take them a while.
void printCounters(uint8_t transmitErrors, uint8_t receiveErrors) {
  printNumber(F("  sent "), roio.counters().sent);
  printNumber(F(", received "), roio.counters().received);
  printNumber(F(", lost "), roio.counters().overflows);
  printNumber(F(", bus-offs "), roio.counters().bus_offs);
  Serial.print(F("; "));
  printState();
  printNumber(F(", error counters "), transmitErrors);
  printNumber(F(" transmit, "), receiveErrors);
  Serial.print(F(" receive; "));
  Serial.println(roio.interruptIsConnected() ? F("INT connected") : F("INT not connected"));
}

void report() {
  static uint16_t sent = 0;
  static uint16_t busOffs = 0;
  static uint16_t errors = 0;
  uint8_t transmitErrors = 0;
  uint8_t receiveErrors = 0;
  roio.errorCounters(transmitErrors, receiveErrors);
  const auto& counters = roio.counters();
  printVerdict(counters.sent != sent,
               counters.bus_offs != busOffs || roio.state() == Roio::State::bus_off,
               counters.message_errors != errors, receiveErrors >= passiveLimit);
  printCounters(transmitErrors, receiveErrors);
  sent = counters.sent;
  busOffs = counters.bus_offs;
  errors = counters.message_errors;
}

// Nobody has this address but itself: all acknowledge the message, and none takes it.
void sendTest() {
  const Roio::Status status = roio.send(Roio::Message(own, nullptr, 0));
  if (status != Roio::Status::ok && status != Roio::Status::full) {  // full: some still wait
    Serial.print(F("The test message was refused: "));
    Serial.println(Roio::toString(status));
  }
}

void setup() {
  Serial.begin(115200);
}

void loop() {
  static uint32_t last = 0;
  Roio::Message message;
  while (roio.receive(message) == Roio::Status::ok) {
    // Counted by now, and that is all.
  }
  if (millis() - last < periodMs) {
    return;
  }
  last = millis();
  if (roio.running()) {
    report();
  }
  if (roio.running() || begin()) {
    sendTest();
  }
}
