// Receives as fast as it can, checks the order, and counts the time that is left over.
//
// Of each message the source is the number: 0.0, 0.1 ... 0.254, 1.0 ... 31.254, 0.0; and so is each
// byte of data, modulo 256. When there is none, it works for WORK cycles (160: 10 us) and
// counts that.
//
// Pin 3 low: work is counted, from 0 on. Pin 4 low: prints, once,
//   received disordered wrong work / driver's received, foreign, overflows, chip losses, line losses
#include <Roio.h>

#ifndef NODE
#define NODE RoioOn<10> roio
#endif
#ifndef TIMING
#define TIMING Roio::bitTiming<16000000, 1000000>()
#endif
#ifndef WORK
#define WORK 160
#endif
NODE;
Roio::Message message;
Roio::Address expected{0, 0};
uint8_t number;
uint32_t received;
uint32_t disordered;
uint32_t wrong;
uint32_t work;
bool counts;
bool printed;

void check() {
  const Roio::Address source = message.source();
  if (source.node != expected.node || source.subnet != expected.subnet) {
    ++disordered;
    expected = source;
    if (message.length() != 0) {
      number = message[0];
    }
  }
  for (uint8_t i = 0; i < message.length(); ++i) {
    if (message[i] != number) {
      ++wrong;
    }
  }
  ++number;
  if (++expected.node == 255) {
    expected.node = 0;
    expected.subnet = (expected.subnet + 1) & 31;
  }
}

void print() {
  const uint32_t numbers[] = {received,
                              disordered,
                              wrong,
                              work,
                              roio.counters().received,
                              roio.counters().foreign,
                              roio.counters().overflows,
                              roio.counters().chip_losses,
                              roio.counters().line_losses};
  Serial.begin(115200);
  for (const uint32_t one : numbers) {
    Serial.print(one);
    Serial.print(' ');
  }
  Serial.println();
}

void setup() {
  PORTD |= (1 << 3) | (1 << 4);  // pull-ups
  if (roio.begin(TIMING, Roio::Address{10, 85}) != Roio::Status::ok) {
    for (;;) {
    }
  }
}

void loop() {
  if (roio.receive(message) == Roio::Status::ok) {
    ++received;
    check();
    return;
  }
  __builtin_avr_delay_cycles(WORK);
  if ((PIND & (1 << 3)) == 0) {
    if (!counts) {
      counts = true;
      work = 0;
    }
    ++work;
  } else {
    counts = false;
    if ((PIND & (1 << 4)) == 0 && !printed) {
      printed = true;
      print();
    }
  }
}
