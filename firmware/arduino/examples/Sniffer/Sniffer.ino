/*
  Sniffer: prints every frame on the bus, of Roio or not, and takes no part in it.

  Wiring
    MCP2515 module    Uno    Leonardo    Mega
    VCC               5V     5V          5V
    GND               GND    GND         GND
    SCK               13     ICSP 3      52
    SI  (MOSI)        11     ICSP 4      51
    SO  (MISO)        12     ICSP 1      50
    CS                10     10          10
    INT               2      2           2
  It only listens and acknowledges nothing: there must be two other nodes on the bus. A frame that
  none of them acknowledges is sent, and printed, again and again.

  500 kbit/s; the module's crystal is named below. Serial at 115200.

  What it prints, as roio-cli dump: who to whom, priority, class, length, data in hexadecimal.
    0.10 -> 0.2 normal message [3] 5A 2D 00
    0.1 -> 0.* urgent message [0]
    foreign 11-bit 123 [2] 11 22
    foreign 29-bit 10004002 [4] remote request
  The bus may be faster than the serial port. So 60 frames wait for it, and what finds no room
  there is counted, and told once a second:
    ! 120 frames not printed, 3 times some lost by the chip
  And when the wire to INT is not there, or comes off:
    ! INT not connected: slower, and may lose more
*/
#include <Roio.h>

// As printed on the module's crystal: 8.000, on the usual blue module, is 8000000. With the wrong
// one the node runs at another bit rate than its bus, though begin() says ok.
constexpr uint32_t crystal = 16000000;
constexpr uint32_t bitrate = 500000;
constexpr Roio::Address unused = {0, 0};  // a listener sends nothing
constexpr uint8_t room = 60;              // for frames that wait to be printed
constexpr int longestLine = 63;           // what the serial port takes without waiting
constexpr uint32_t periodMs = 1000;

struct Options : RoioOptions {
  static constexpr uint8_t rx_queue = room + 4;
  static constexpr bool every_frame = true;
};

RoioOn<10, 2, Options> roio;  // CS, INT
uint32_t notPrinted = 0;

Roio::Status begin() {
  return roio.begin(Roio::bitTiming<crystal, bitrate>(), unused, Roio::everything(),
                    Roio::Mode::listen_only);
}

// The chip itself holds two frames, so this must be called more often than they come: between any
// two pieces of a line.
void fetch() {
  if (roio.poll() != Roio::Status::ok) {
    return;  // loop() sees to it
  }
  Roio::Frame dropped;
  while (roio.fetched() > room && roio.receive(dropped) == Roio::Status::ok) {
    ++notPrinted;
  }
}

void printAddress(Roio::Address address) {
  Serial.print(address.subnet);
  Serial.print('.');
  fetch();
  if (address.node == 255) {
    Serial.print('*');
  } else {
    Serial.print(address.node);
  }
  fetch();
}

void printHeader(const Roio::Header& header) {
  printAddress(header.source);
  Serial.print(F(" -> "));
  printAddress(header.destination);
  Serial.print(header.priority == Roio::Priority::urgent ? F(" urgent ") : F(" normal "));
  fetch();
  switch (header.message_class) {
    case Roio::MessageClass::system:
      Serial.print(F("system"));
      break;
    case Roio::MessageClass::stream:
      Serial.print(F("stream"));
      break;
    default:
      Serial.print(F("message"));
      break;
  }
  fetch();
}

void printForeign(const Roio::Frame& frame, bool isLong) {
  Serial.print(isLong ? F("foreign 29-bit ") : F("foreign 11-bit "));
  for (uint8_t digit = isLong ? 8 : 3; digit > 0; --digit) {
    Serial.print(static_cast<uint8_t>(frame.id >> (4 * (digit - 1))) & 0x0F, HEX);
  }
  fetch();
}

// Only extended data frames are Roio's, and of those, not the ones that no node can send.
bool isRoio(const Roio::Frame& frame, const Roio::Header& header) {
  return frame.kind == Roio::FrameKind::extended &&
         header.message_class != Roio::MessageClass::reserved && header.source.node != 255;
}

void printFrame(const Roio::Frame& frame) {
  const Roio::Header header = Roio::headerOf(frame);
  fetch();
  const bool isRemote = frame.kind == Roio::FrameKind::standard_remote ||
                        frame.kind == Roio::FrameKind::extended_remote;
  if (isRoio(frame, header)) {
    printHeader(header);
  } else {
    printForeign(frame, frame.kind == Roio::FrameKind::extended ||
                            frame.kind == Roio::FrameKind::extended_remote);
  }
  Serial.print(F(" ["));
  Serial.print(frame.length);
  Serial.print(isRemote ? F("] remote request") : F("]"));
  fetch();
  for (uint8_t i = 0; i < frame.length && !isRemote; ++i) {
    Serial.print(frame.data[i] < 0x10 ? F(" 0") : F(" "));
    Serial.print(frame.data[i], HEX);
    fetch();
  }
  Serial.println();
}

// Once a second, when there are new ones.
bool mustTellLosses() {
  static uint32_t last = 0;
  static uint32_t told = 0;
  const uint32_t losses = notPrinted + roio.counters().overflows;
  if (losses == told || millis() - last < periodMs) {
    return false;
  }
  told = losses;
  last = millis();
  return true;
}

void printLosses() {
  Serial.print(F("! "));
  fetch();
  Serial.print(notPrinted);  // 40 us a digit
  fetch();
  Serial.print(F(" frames not printed, "));
  fetch();
  Serial.print(roio.counters().overflows);
  fetch();
  Serial.println(F(" times some lost by the chip"));
}

// Once for each time that it was found so.
bool mustTellInt() {
  static uint16_t told = 0;
  const bool isNew = roio.counters().line_losses != told;
  told = roio.counters().line_losses;
  return isNew;
}

void printInt() {
  Serial.print(F("! INT not connected: "));
  fetch();
  Serial.println(F("slower, and may lose more"));
}

void setup() {
  Serial.begin(115200);
  const Roio::Status status = begin();
  if (status != Roio::Status::ok) {
    Serial.print(F("! Cannot begin, "));
    Serial.print(Roio::toString(status));
    Serial.println(F(": check the wiring and the CS pin"));
  }
}

void loop() {
  // When the chip was not there, or has been without power.
  if (!roio.running() && begin() != Roio::Status::ok) {
    return;
  }
  fetch();
  if (Serial.availableForWrite() < longestLine) {
    return;  // printing would have to wait
  }
  Roio::Frame frame;
  if (mustTellLosses()) {
    printLosses();
  } else if (mustTellInt()) {
    printInt();
  } else if (roio.receive(frame) == Roio::Status::ok) {
    printFrame(frame);
  }
}
