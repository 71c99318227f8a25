/// Roio: a robot's nervous system on CAN, for Arduinos with an MCP2515 controller.
///
///   #include <Roio.h>
///
///   constexpr uint32_t crystal = 16000000;  // as printed on the module's crystal
///   constexpr uint32_t bitrate = 500000;
///   constexpr Roio::Address own = {0, 2};
///
///   RoioOn<10> roio;  // chip select on pin 10; or RoioOn<10, 2> with INT on pin 2
///
///   void loop() {
///     if (!roio.running() && roio.begin<crystal, bitrate>(own) != Roio::Status::ok) {
///       return;  // no chip yet: try again
///     }
///     Roio::Message message;
///     if (roio.receive(message) == Roio::Status::ok) { ... }
///   }
///
/// Roio roio(10) is the same, with the calls of the first Roio library (2014) besides. All names
/// that a sketch needs are members of class Roio: Roio::Message, Roio::Status::ok, Roio::Address{0,
/// 2}. The reference is roio/arduino_node.hpp, roio/arduino_message.hpp and
/// roio/arduino_classic.hpp.
#ifndef ROIO_H
#define ROIO_H

#include <Arduino.h>
#include <SPI.h>
#include <stdint.h>

#ifdef ROIO_STATUS_HPP
#error "Include Roio.h before all other files of Roio"
#endif

// A sketch calls its node `roio`, and no namespace may have that name beside it. So in sketches the
// library's namespace has another one.
#define roio roio_library
#include <roio/arduino_classic.hpp>

/// Roio roio(10);
using Roio = roio::ClassicNode;

// For changeMode(), as in 2014; Roio::Mode has them, too.
constexpr uint8_t CANMODE_NORMAL = 0x00;
constexpr uint8_t CANMODE_SLEEP = 0x20;
constexpr uint8_t CANMODE_LOOP = 0x40;
constexpr uint8_t CANMODE_LISTEN = 0x60;
constexpr uint8_t CANMODE_CONFIG = 0x80;

/// What RoioOn<> leaves in or out: derive from it, and change what differs.
using RoioOptions = roio::ArduinoOptions;

/// A node whose pins are known when compiling, which is smaller and faster: RoioOn<10> roio;
/// @tparam InterruptPin where the chip's INT is connected, if it is: then a call that finds nothing
///         costs no SPI.
template <uint8_t ChipSelectPin, int InterruptPin = -1, typename Options = RoioOptions>
using RoioOn = roio::ArduinoNode<
    roio::ArduinoPort<roio::FixedPin<ChipSelectPin>, roio::PinOrNone<InterruptPin>>, Options>;
#undef roio

#endif
