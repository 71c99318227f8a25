// Has a warning in it, which tests/firmware/arduino must notice.
void setup() { int unused; }
void loop() {}
