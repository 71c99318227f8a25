/// What differs between boards and wirings. Change it here, or with -D.
#ifndef ROIO_BRIDGE_CONFIG_H
#define ROIO_BRIDGE_CONFIG_H

// The driver has to keep up with a full bus; all else is compiled for size, as Arduino does it.
#pragma GCC push_options
#pragma GCC optimize("O2")
#include <RoioDriver.h>
#pragma GCC pop_options

#ifndef ROIO_BRIDGE_CS_PIN
#define ROIO_BRIDGE_CS_PIN 10
#endif
/// Whether anything is connected to it is found out when the board starts.
#ifndef ROIO_BRIDGE_INT_PIN
#define ROIO_BRIDGE_INT_PIN 2
#endif

// ROIO_BRIDGE_UART: on a Leonardo, speak over the UART on pins 0 and 1 instead of USB.
#if defined(USBCON) && !defined(ROIO_BRIDGE_UART)
#define ROIO_BRIDGE_OVER_USB
#endif

/// What is done for each frame, and has to keep up with a full bus. All else is compiled for size,
/// as Arduino does it.
#define ROIO_BRIDGE_FAST __attribute__((optimize("O2")))

namespace roio {
namespace bridge {

#if defined(__AVR_ATmega328P__)
constexpr serial::Board board = serial::Board::uno;
#elif defined(__AVR_ATmega32U4__)
constexpr serial::Board board = serial::Board::leonardo;
#elif defined(__AVR_ATmega2560__)
constexpr serial::Board board = serial::Board::mega;
#else
constexpr serial::Board board = serial::Board::other;
#endif

/// As a node of the network, until ADDRESS says another one.
constexpr Address default_address = {0, 254};
constexpr uint32_t default_bitrate_bps = 500000;

}  // namespace bridge
}  // namespace roio

#endif
