// The example ServoController with its bytes read and written by hand: what the one with a generated
// header must not be larger than.
#include <Roio.h>

#include "TimerServo.h"  // without an AVR: #include <Servo.h>, and Servo in place of TimerServo

// As printed on the module's crystal: 8.000, on the usual blue module, is 8000000. With the wrong
// one the node runs at another bit rate than its bus, though begin() says ok.
constexpr uint32_t crystal = 16000000;
constexpr uint32_t bitrate = 500000;
constexpr Roio::Address own = {0, 2};

constexpr uint8_t servoCount = 3;
constexpr uint8_t servoPins[servoCount] = {3, 5, 6};
constexpr uint8_t startAngle = 45;
constexpr uint8_t largestAngle = 180;

RoioOn<10> roio;  // CS
TimerServo servos[servoCount];
uint16_t refused = 0;

// All or none: half an order could move the arm where nobody wanted it.
bool move(const Roio::Message& message) {
  if (message.length() != servoCount) {
    return false;
  }
  for (uint8_t i = 0; i < servoCount; ++i) {
    if (message[i] > largestAngle) {
      return false;
    }
  }
  for (uint8_t i = 0; i < servoCount; ++i) {
    servos[i].write(message[i]);
  }
  return true;
}

bool tellRefused(Roio::Address asker) {
  const uint8_t answer[] = {highByte(refused), lowByte(refused)};
  return roio.send(Roio::Message(asker, answer, sizeof answer)) == Roio::Status::ok;
}

bool obey(const Roio::Message& message) {
  return message.length() == 0 ? tellRefused(message.source()) : move(message);
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
