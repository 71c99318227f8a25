// What Arduino's serial port costs: sends back what it receives.
void setup() { Serial.begin(115200); }

void loop() {
  if (Serial.available() > 0) {
    Serial.write(Serial.read());
  }
}
