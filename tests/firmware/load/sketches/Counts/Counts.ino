
// --- tests/firmware/load: prints the counters when pin 3 is low ---------------------------------------
// This is appended to the example Echo, whose setup() and loop() got other names:
//   received foreign overflows sent unknown chip_losses waiting

#undef setup
#undef loop

void setup() {
  pinMode(3, INPUT_PULLUP);
  Serial.begin(115200);
  echoSetup();
}

void loop() {
  static bool printed = false;
  echoLoop();
  if (digitalRead(3) == HIGH) {
    printed = false;
  } else if (!printed) {
    printed = true;
    const auto& counters = roio.counters();
    const uint16_t numbers[] = {counters.received, counters.foreign,     counters.overflows,
                                counters.sent,     counters.unknown,     counters.chip_losses,
                                roio.waiting(),    waiting ? 1U : 0U};
    for (const uint16_t one : numbers) {
      Serial.print(one);
      Serial.print(' ');
    }
    Serial.println();
  }
}
