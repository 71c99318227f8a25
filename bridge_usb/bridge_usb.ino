/*
  Bridge: makes an Arduino with an MCP2515 the PC's way to the CAN bus, over USB.

  Wiring, flashing and use: docs/bridge.md. The PC's side: `roio-cli bridge`, or any program that
  opens serial:/dev/ttyACM0; or one that speaks SLCAN, such as slcand. What goes over the line:
  docs/serial-protocol.md.

  Parts
    line_uart.h, line_usb.h   bytes to and from the PC
    can_side.h                the MCP2515
    session.h                 Roio's protocol
    slcan_side.h              SLCAN
    own_node.h                the bridge as a node of the network
*/
#include <RoioDriver.h>

#include "can_side.h"
#include "clock.h"
#include "indicator.h"
#include "line.h"
#include "own_node.h"
#include "session.h"
#include "slcan_side.h"
#include "tally.h"

using namespace roio::bridge;

static Line line;
static Clock clock;
static CanSide can(clock);
static Tally tally(can, line);
static OwnNode node(tally, can);
static Indicator indicator(line, clock);
static Session session(line, can, tally, node, indicator, clock);
static SlcanSide slcan(line, can, tally, clock);

// The chip holds two frames, so it comes before all else.
static void takeFromBus() {
  roio::Mcp2515Frame frame;
  while (can.receive(frame) == roio::Status::ok) {
    const uint16_t ticks = Clock::low_ticks();
    node.take(frame);
    if (slcan.is_open()) {
      slcan.forward(frame);
    } else {
      session.forward(frame, ticks);
    }
    if (!can.more_waits()) {
      break;
    }
  }
}

// As much as fits between two looks at the bus.
static void takeFromPc() {
  constexpr uint8_t most = 8;
  uint8_t byte;
  for (uint8_t i = 0; i < most && line.take(byte); ++i) {
    session.take(byte);
    if (!session.is_open()) {
      slcan.take(byte);
    }
  }
}

void setup() {
  Clock::begin();
  line.begin(roio::serial::base_rate_bps);
  Indicator::begin();
  can.begin();
}

void loop() {
  takeFromBus();
  takeFromPc();
  if (session.is_open()) {
    slcan.leave();
  }
  session.tend();
  can.tend();
  indicator.tend();
  line.pump();
}
