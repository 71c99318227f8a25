/// Where the pins of the common AVR boards are, known when compiling: Arduino's own tables lie in
/// flash, where a compiler does not look. A board that is not here costs a lookup, and works.
/// tests/firmware/arduino compares these with Arduino's tables.
/// Source: Arduino's variants standard, leonardo, mega (pins_arduino.h).
#ifndef ROIO_ARDUINO_PIN_MAP_AVR_HPP
#define ROIO_ARDUINO_PIN_MAP_AVR_HPP

#include <stdint.h>

#if defined(__AVR_ATmega328P__) || defined(__AVR_ATmega168__)
#define ROIO_AVR_SPI_SS 2
#define ROIO_AVR_SPI_MOSI 3
#define ROIO_AVR_SPI_SCK 5
#elif defined(__AVR_ATmega32U4__) || defined(__AVR_ATmega2560__) || defined(__AVR_ATmega1280__)
#define ROIO_AVR_SPI_SS 0
#define ROIO_AVR_SPI_SCK 1
#define ROIO_AVR_SPI_MOSI 2
#endif

namespace roio {

struct AvrPinPlace {
  uint16_t port;  ///< The address of PORTx; 0: not known.
  uint8_t bit;

  /// By one instruction: the others are read, changed and written.
  constexpr bool is_reachable() const { return port != 0 && port < 0x40; }
};

namespace avr_ports {
constexpr uint16_t a = 0x22;
constexpr uint16_t b = 0x25;
constexpr uint16_t c = 0x28;
constexpr uint16_t d = 0x2B;
constexpr uint16_t e = 0x2E;
constexpr uint16_t f = 0x31;
constexpr uint16_t g = 0x34;
constexpr uint16_t h = 0x102;
constexpr uint16_t j = 0x105;
constexpr uint16_t k = 0x108;
constexpr uint16_t l = 0x10B;
}  // namespace avr_ports

namespace detail {

constexpr AvrPinPlace at(uint16_t port, uint8_t bit) {
  return AvrPinPlace{port, bit};
}
constexpr AvrPinPlace rising(uint16_t port, uint8_t pin, uint8_t first) {
  return AvrPinPlace{port, static_cast<uint8_t>(pin - first)};
}
constexpr AvrPinPlace falling(uint16_t port, uint8_t pin, uint8_t last) {
  return AvrPinPlace{port, static_cast<uint8_t>(last - pin)};
}

}  // namespace detail

#if defined(ARDUINO_AVR_UNO) || defined(ARDUINO_AVR_NANO) || defined(ARDUINO_AVR_PRO) || \
    defined(ARDUINO_AVR_MINI) || defined(ARDUINO_AVR_DUEMILANOVE)

constexpr AvrPinPlace avr_pin_place(uint8_t pin) {
  return pin < 8    ? detail::rising(avr_ports::d, pin, 0)
         : pin < 14 ? detail::rising(avr_ports::b, pin, 8)
         : pin < 20 ? detail::rising(avr_ports::c, pin, 14)
                    : AvrPinPlace{0, 0};
}

#elif defined(ARDUINO_AVR_LEONARDO) || defined(ARDUINO_AVR_MICRO)

constexpr AvrPinPlace avr_pin_place(uint8_t pin) {
  return pin < 2     ? detail::rising(avr_ports::d, static_cast<uint8_t>(pin + 2), 0)
         : pin < 4   ? detail::falling(avr_ports::d, pin, 3)
         : pin == 4  ? detail::at(avr_ports::d, 4)
         : pin == 5  ? detail::at(avr_ports::c, 6)
         : pin == 6  ? detail::at(avr_ports::d, 7)
         : pin == 7  ? detail::at(avr_ports::e, 6)
         : pin < 12  ? detail::rising(avr_ports::b, pin, 4)
         : pin == 12 ? detail::at(avr_ports::d, 6)
         : pin == 13 ? detail::at(avr_ports::c, 7)
         : pin == 14 ? detail::at(avr_ports::b, 3)
         : pin < 17  ? detail::rising(avr_ports::b, pin, 14)
         : pin == 17 ? detail::at(avr_ports::b, 0)
         : pin < 22  ? detail::falling(avr_ports::f, pin, 25)
         : pin < 24  ? detail::falling(avr_ports::f, pin, 23)
                     : AvrPinPlace{0, 0};
}

#elif defined(ARDUINO_AVR_MEGA2560) || defined(ARDUINO_AVR_MEGA) || defined(ARDUINO_AVR_ADK)

constexpr AvrPinPlace avr_pin_place(uint8_t pin) {
  return pin < 2     ? detail::rising(avr_ports::e, pin, 0)
         : pin < 4   ? detail::rising(avr_ports::e, static_cast<uint8_t>(pin + 2), 0)
         : pin == 4  ? detail::at(avr_ports::g, 5)
         : pin == 5  ? detail::at(avr_ports::e, 3)
         : pin < 10  ? detail::rising(avr_ports::h, pin, 3)
         : pin < 14  ? detail::rising(avr_ports::b, pin, 6)
         : pin < 16  ? detail::falling(avr_ports::j, pin, 15)
         : pin < 18  ? detail::falling(avr_ports::h, pin, 17)
         : pin < 22  ? detail::falling(avr_ports::d, pin, 21)
         : pin < 30  ? detail::rising(avr_ports::a, pin, 22)
         : pin < 38  ? detail::falling(avr_ports::c, pin, 37)
         : pin == 38 ? detail::at(avr_ports::d, 7)
         : pin < 42  ? detail::falling(avr_ports::g, pin, 41)
         : pin < 50  ? detail::falling(avr_ports::l, pin, 49)
         : pin < 54  ? detail::falling(avr_ports::b, pin, 53)
         : pin < 62  ? detail::rising(avr_ports::f, pin, 54)
         : pin < 70  ? detail::rising(avr_ports::k, pin, 62)
                     : AvrPinPlace{0, 0};
}

#else

constexpr AvrPinPlace avr_pin_place(uint8_t) {
  return AvrPinPlace{0, 0};
}

#endif

}  // namespace roio

#endif
