/// RoioDriver: the driver, its Arduino port and the serial protocol, for firmware that is more than
/// a node of the network, such as the USB bridge. All of it is in namespace roio. Sketches include
/// Roio.h instead.
#ifndef ROIO_DRIVER_H
#define ROIO_DRIVER_H

#include <Arduino.h>
#include <SPI.h>
#include <stdint.h>

#include <roio/arduino_port.hpp>
#include <roio/bit_timing.hpp>
#include <roio/mcp2515.hpp>
#include <roio/message.hpp>
#include <roio/serial_protocol.hpp>
#include <roio/serial_record.hpp>
#include <roio/version.hpp>

#endif
