// When it gets a message: ten normal ones to 0.10, numbered from 0, and then an urgent one, 255. Pin 5
// goes high when the urgent one was taken, pin 6 when anything was refused.
#include <Roio.h>

struct Options : RoioOptions {
  static constexpr uint8_t tx_queue = 12;
};
RoioOn<10, -1, Options> roio;

void give(uint8_t number, Roio::Priority priority) {
  if (roio.send(Roio::Message(Roio::Address{0, 10}, &number, 1, priority)) != Roio::Status::ok) {
    digitalWrite(6, HIGH);
  }
}

void setup() {
  pinMode(5, OUTPUT);
  pinMode(6, OUTPUT);
  if (roio.begin(500, 2, 0) != Roio::Status::ok) {
    digitalWrite(6, HIGH);
  }
}

void loop() {
  Roio::Message message;
  if (roio.receive(message) == Roio::Status::ok) {
    for (uint8_t number = 0; number < 10; ++number) {
      give(number, Roio::Priority::normal);
    }
    give(255, Roio::Priority::urgent);
    digitalWrite(5, HIGH);
  }
}
