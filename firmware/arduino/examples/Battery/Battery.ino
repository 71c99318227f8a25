/*
  Battery: a node that sleeps, processor and MCP2515 both, until there is something on the bus.

  Wiring
    MCP2515 module    Uno    Leonardo    Mega
    VCC               5V     5V          5V
    GND               GND    GND         GND
    SCK               13     ICSP 3      52
    SI  (MOSI)        11     ICSP 4      51
    SO  (MISO)        12     ICSP 1      50
    CS                10     10          10
    INT               2      2           2
  Between CANH and CANL belong 120 ohms at each end of the bus. What still draws current: the
  module's transceiver, and the board's own USB chip, regulator and light.

  Address 0.6, 500 kbit/s; the module's crystal is named below.

  What it does: a second after the last message to it, it sleeps. Any message on the bus wakes it,
  and the chip loses that one: who wants something of it sends again until an answer comes. The
  answer to each message is how often it has slept, 2 bytes, high byte first.
*/
#include <Roio.h>
#include <avr/sleep.h>

// As printed on the module's crystal: 8.000, on the usual blue module, is 8000000. With the wrong
// one the node runs at another bit rate than its bus, though begin() says ok.
constexpr uint32_t crystal = 16000000;
constexpr uint32_t bitrate = 500000;
constexpr Roio::Address own = {0, 6};
constexpr uint32_t awakeMs = 1000;
constexpr uint8_t interruptPin = 2;

RoioOn<10, interruptPin> roio;  // CS, INT
uint16_t sleeps = 0;
uint32_t lastMs = 0;

// INT stays low until loop() comes, and would interrupt again and again.
void onInterrupt() {
  detachInterrupt(digitalPinToInterrupt(interruptPin));
}

// Until INT is low. millis() stands still meanwhile.
void sleepProcessor() {
  set_sleep_mode(SLEEP_MODE_PWR_DOWN);
  attachInterrupt(digitalPinToInterrupt(interruptPin), onInterrupt, LOW);
  sleep_enable();
  noInterrupts();
  while (digitalRead(interruptPin) == HIGH) {
    interrupts();  // none comes between this and the next instruction
    sleep_cpu();
    noInterrupts();
  }
  interrupts();
  sleep_disable();
}

// Not without INT: nothing would wake the processor.
void sleep() {
  if (!roio.interruptIsConnected() || roio.sleep() != Roio::Status::ok) {
    return;  // an answer has still to be sent, or loop() begins again
  }
  ++sleeps;
  sleepProcessor();
  if (roio.wake() == Roio::Status::ok) {
    lastMs = millis();
  }
}

bool answer(Roio::Address asker) {
  const uint8_t count[] = {highByte(sleeps), lowByte(sleeps)};
  return roio.send(Roio::Message(asker, count, sizeof count)) == Roio::Status::ok;
}

void setup() {}

void loop() {
  // The first time, and again after the chip was without power.
  if (!roio.running() && roio.begin<crystal, bitrate>(own) != Roio::Status::ok) {
    return;
  }
  Roio::Message message;
  if (roio.receive(message) == Roio::Status::ok) {
    lastMs = millis();
    answer(message.source());  // no room: who asks will ask again
  } else if (millis() - lastMs >= awakeMs) {
    sleep();
  }
}
