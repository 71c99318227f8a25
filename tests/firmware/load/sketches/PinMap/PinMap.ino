// Compares the pins as Roio knows them when compiling with Arduino's tables, and prints each that
// differs, then "<pins> pins, <known> known, <wrong> wrong".
#include <Roio.h>

#if defined(__AVR_ATmega32U4__)
#define OUT Serial1
#else
#define OUT Serial
#endif

void setup() {
  uint8_t known = 0;
  uint8_t wrong = 0;
  OUT.begin(115200);
  for (uint8_t pin = 0; pin < NUM_DIGITAL_PINS; ++pin) {
    const roio_library::AvrPinPlace place = roio_library::avr_pin_place(pin);
    if (place.port == 0) {
      continue;
    }
    ++known;
    const uint8_t port = digitalPinToPort(pin);
    const bool same = port != NOT_A_PIN &&
                      place.port == reinterpret_cast<uint16_t>(portOutputRegister(port)) &&
                      (1 << place.bit) == digitalPinToBitMask(pin);
    if (!same) {
      ++wrong;
      OUT.print(F("pin "));
      OUT.println(pin);
    }
  }
  // Past the end nothing is known.
  for (uint16_t pin = NUM_DIGITAL_PINS; pin <= 255; ++pin) {
    if (roio_library::avr_pin_place(static_cast<uint8_t>(pin)).port != 0) {
      ++wrong;
      OUT.print(F("no pin "));
      OUT.println(pin);
    }
  }
  OUT.print(NUM_DIGITAL_PINS);
  OUT.print(F(" pins, "));
  OUT.print(known);
  OUT.print(F(" known, "));
  OUT.print(wrong);
  OUT.println(F(" wrong"));
}

void loop() {}
