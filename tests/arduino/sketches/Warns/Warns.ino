// Has a warning in it, which tests/arduino must notice.
void setup() { int unused; }
void loop() {}
