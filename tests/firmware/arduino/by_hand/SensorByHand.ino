// The example SensorBoard with its bytes written by hand: what the one with a generated header must not
// be larger than.
#include <Roio.h>

// As printed on the module's crystal: 8.000, on the usual blue module, is 8000000. With the wrong
// one the node runs at another bit rate than its bus, though begin() says ok.
constexpr uint32_t crystal = 16000000;
constexpr uint32_t bitrate = 500000;
constexpr Roio::Address own = {0, 3};
constexpr Roio::Address listener = {0, 10};

constexpr uint8_t lightPin = A0;
constexpr uint8_t buttonPins[] = {4, 5};
constexpr uint8_t potPins[] = {A1, A2, A3};
constexpr uint8_t lightStep = 5;
constexpr uint8_t potStep = 1;
constexpr uint32_t debounceMs = 200;

struct Values {
  uint8_t light;
  uint8_t clicks[2];
  uint8_t pots[3];
};

RoioOn<10> roio;  // CS
Values now = {};
Values told = {};
bool due;  // until the message is on its way: a change is not forgotten when the bus is full

void countClicks() {
  static uint32_t lastDown[2];
  for (uint8_t i = 0; i < 2; ++i) {
    if (digitalRead(buttonPins[i]) == LOW) {
      // Contacts bounce, also when they open: a click is what comes after 200 ms without any.
      if (millis() - lastDown[i] >= debounceMs) {
        ++now.clicks[i];
      }
      lastDown[i] = millis();
    }
  }
}

uint8_t read8Bits(uint8_t pin) {
  return analogRead(pin) / 4;
}

void measure() {
  countClicks();
  now.light = read8Bits(lightPin);
  for (uint8_t i = 0; i < 3; ++i) {
    now.pots[i] = read8Bits(potPins[i]);
  }
}

bool differs(uint8_t a, uint8_t b, uint8_t step) {
  return a > b ? a - b > step : b - a > step;
}

bool hasChanged() {
  bool changed = differs(now.light, told.light, lightStep);
  for (uint8_t i = 0; i < 3; ++i) {
    changed = changed || differs(now.pots[i], told.pots[i], potStep);
  }
  for (uint8_t i = 0; i < 2; ++i) {
    changed = changed || now.clicks[i] != told.clicks[i];
  }
  return changed;
}

bool tell() {
  const uint8_t bytes[] = {now.light,   now.clicks[0], now.clicks[1],
                           now.pots[0], now.pots[1],   now.pots[2]};
  return roio.send(Roio::Message(listener, bytes, sizeof bytes)) == Roio::Status::ok;
}

bool begin() {
  return roio.begin<crystal, bitrate>(own) == Roio::Status::ok;
}

void setup() {
  for (uint8_t pin : buttonPins) {
    pinMode(pin, INPUT_PULLUP);
  }
}

void loop() {
  measure();
  due = due || hasChanged();
  // The first time, and again after the chip was without power.
  if (roio.poll() != Roio::Status::ok) {
    if (!begin()) {
      return;
    }
    due = true;  // the first message; later, what the chip had not sent yet is gone
  }
  if (due && tell()) {
    told = now;
    due = false;
  }
}
