/*
  ServoController: three servos, an arm for example, moved by messages.

  Wiring
    MCP2515 module    Uno    Leonardo    Mega
    VCC               5V     5V          5V
    GND               GND    GND         GND
    SCK               13     ICSP 3      52
    SI  (MOSI)        11     ICSP 4      51
    SO  (MISO)        12     ICSP 1      50
    CS                10     10          10
  Servo signals: pins 3, 5, 6. Servos have a 5 V supply of their own, its ground joined to the
  Arduino's. Between CANH and CANL belong 120 ohms at each end of the bus.

  Address 0.2, 500 kbit/s; the module's crystal is named below.

  What it does: the servos go to 45 degrees. Then, messages to 0.2:
    3 bytes   an angle for each servo, 0 to 180 degrees
    0 bytes   a question: the answer is how many messages were refused, 2 bytes, high byte first
  Any other length, or an angle above 180: the message is refused, no servo moves, and it is
  counted. So is a question that comes while two answers still wait for the bus. Messages to all,
  0.*, are not meant for an arm: it ignores them.
*/
#include <Roio.h>

#include "servo_arm.h"   // what its messages hold, made from kinds/servo-arm.kind.json
#include "TimerServo.h"  // without an AVR: #include <Servo.h>, and Servo in place of TimerServo

// As printed on the module's crystal: 8.000, on the usual blue module, is 8000000. With the wrong
// one the node runs at another bit rate than its bus, though begin() says ok.
constexpr uint32_t crystal = 16000000;
constexpr uint32_t bitrate = 500000;
constexpr Roio::Address own = {0, 2};

constexpr uint8_t servoCount = 3;
constexpr uint8_t servoPins[servoCount] = {3, 5, 6};
constexpr uint8_t startAngle = 45;

RoioOn<10> roio;  // CS
TimerServo servos[servoCount];
uint16_t refused = 0;

void move(const servo_arm::heard::Angles& angles) {
  const uint8_t degrees[servoCount] = {angles.shoulder, angles.elbow, angles.hand};
  uint8_t i = 0;
  for (TimerServo& servo : servos) {
    servo.write(degrees[i++]);
  }
}

bool tellRefused(Roio::Address asker) {
  uint8_t answer[servo_arm::said::refusals::length];
  if (!pack(servo_arm::said::Refusals{refused}, answer)) {
    return false;
  }
  return roio.send(Roio::Message(asker, answer, sizeof answer)) == Roio::Status::ok;
}

bool obey(const Roio::Message& message) {
  servo_arm::heard::Refusals question;
  if (unpack(message, question)) {
    return tellRefused(message.source());
  }
  servo_arm::heard::Angles angles;
  // All or none: half an order could move the arm where nobody wanted it.
  if (!unpack(message, angles)) {
    return false;
  }
  move(angles);
  return true;
}

void setup() {
  for (uint8_t i = 0; i < servoCount; ++i) {
    servos[i].write(startAngle);
    servos[i].attach(servoPins[i]);
  }
}

void loop() {
  // First of all, and again when the chip was without power.
  if (!roio.running() && roio.begin<crystal, bitrate>(own) != Roio::Status::ok) {
    return;
  }
  Roio::Message message;
  if (roio.receive(message) == Roio::Status::ok && !message.isBroadcast() && !obey(message)) {
    ++refused;
  }
}
