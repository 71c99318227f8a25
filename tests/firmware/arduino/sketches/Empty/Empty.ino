// What Arduino itself costs.
void setup() {}
void loop() {}
