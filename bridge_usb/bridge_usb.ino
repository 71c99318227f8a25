/*
  Bridge: makes an Arduino with an MCP2515 the PC's way to the CAN bus, over USB.

  Wiring, flashing and use: docs/bridge.md. The PC's side: `roio-cli bridge`, or any program that
  opens serial:/dev/ttyACM0; or one that speaks SLCAN, such as slcand. What goes over the line:
  docs/internals/serial-protocol.md.

  Parts
    line_uart.h, line_usb.h   bytes to and from the PC
    can_side.h, slots.h       the MCP2515; what becomes of each frame for the bus, and until when
    session.h                 Roio's protocol: how a session begins, goes on and ends
      session_down.h            what the PC sends: frames for the bus, and requests
      session_up.h              what it gets: frames from the bus, answers and reports
      frame_body.h, pc_filter.h a frame in a record, and which of them the PC wants
    slcan_side.h              SLCAN
    own_node.h                the bridge as a node of the network
*/
#include "config.h"

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
// @return whether there was one.
static bool takeFromBus() {
  roio::Mcp2515Frame frame;
  if (can.receive(frame) != roio::Status::ok) {
    return false;
  }
  const uint16_t ticks = Clock::low_ticks();
  node.take(frame);
  if (slcan.is_open()) {
    slcan.forward(frame);
  } else {
    session.forward(frame, ticks);
  }
  if (line.room() < Line::pump_below) {
    line.pump();
  }
  return true;
}

// Takes in what has come, up to the end of a record.
// @return whether there may be more.
static bool takeBytes() {
  constexpr uint8_t most = 24;
  const uint8_t* bytes = nullptr;
  uint8_t count = line.peek(bytes);
  if (count == 0 || session.has_record()) {
    return false;
  }
  if (count > most) {
    count = most;
  }
  const bool isText = !session.is_open();
  session.take(bytes, count);
  if (isText) {
    for (uint8_t i = 0; i < count; ++i) {
      slcan.take(bytes[i]);
    }
  }
  line.consume(count);
  return true;
}

// Whether a frame may wait in the chip. Without an INT line nobody knows; so it is looked at after
// each thing that takes long.
static bool busCalls(bool didSomething) {
  return didSomething ? !can.is_quiet() : can.has_received();
}

// @return whether there was anything to do.
static bool takeFromPc(bool mayWait) {
  // More come meanwhile: a record is served as soon as its last byte is there.
  constexpr uint8_t mostTries = 8;
  bool didSomething = false;
  for (uint8_t tries = mostTries; tries != 0 && takeBytes(); --tries) {
    didSomething = true;
    if (!can.is_quiet()) {
      break;
    }
  }
  if (session.has_record() && !(mayWait && busCalls(didSomething))) {
    session.serve();
    didSomething = true;
  }
  return didSomething;
}

void setup() {
  Clock::begin();
  line.begin(roio::serial::base_rate_bps);
  Indicator::begin();
  can.begin();
}

void loop() {
  // The bus comes first, and the rest in turn; but it does not wait for ever, also when the line of
  // a controller that is lost says that there is always one more frame.
  constexpr uint8_t mostInARow = 250;
  constexpr uint8_t mostOnAFastBus = 24;
  static uint8_t inARow = 0;
  static bool isTime = false;
  ++inARow;
  const bool mayWait = inARow < (can.is_fast() ? mostOnAFastBus : mostInARow);
  if (takeFromBus() && mayWait) {
    return;
  }
  isTime = clock.update() || isTime;  // about every millisecond
  const bool didSomething = takeFromPc(mayWait);
  if (mayWait && busCalls(didSomething)) {
    return;
  }
  inARow = 0;
  session.answer();
  line.pump();
  if (isTime) {
    isTime = false;
    if (session.is_open()) {
      slcan.leave();
    }
    session.tend();
    can.tend();
    indicator.tend();
  }
}
