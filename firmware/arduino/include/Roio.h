/// Roio: a robot's nervous system on CAN, for Arduinos with an MCP2515.
#ifndef ROIO_H
#define ROIO_H

#include <Arduino.h>
#include <SPI.h>
#include <stdint.h>

#ifdef ROIO_STATUS_HPP
#error "Include Roio.h alone, or before all other files of Roio"
#endif

// A sketch calls its node `roio`, and no namespace may have that name beside it. So in sketches the
// library's namespace has another one, and all that a sketch needs is a member of class Roio:
// Roio::Message, Roio::Status::ok.
#define roio roio_library
#include <roio/arduino_node.hpp>

class Roio : public roio::ArduinoNode<roio::ArduinoOptions> {
 public:
  using ArduinoNode::ArduinoNode;
};
#undef roio

#endif
