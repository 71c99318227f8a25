// Every call that a node has beside the original's, each way to have filters, and all that may be
// chosen. Each call's result is shown, so that none can be left out of the image.
#include <Roio.h>

struct Options : RoioOptions {
  static constexpr uint8_t tx_queue = 4;
  static constexpr uint8_t rx_queue = 4;
  static constexpr bool only_buffer_0 = true;
  static constexpr bool diagnoses = true;
};
struct EveryFrame : RoioOptions {
  static constexpr bool every_frame = true;
};

RoioOn<10, 2, Options> roio;
RoioOn<9, -1, EveryFrame> listener;
RoioOn<8, 3> plain;

constexpr Roio::Address own{0, 2};

void show(Roio::Status status) { Serial.println(static_cast<uint8_t>(status)); }

void beginEachWay() {
  constexpr Roio::BitTiming timing = Roio::bitTiming<8000000, 500000>();
  // Its own messages, and broadcasts to its own subnet and to subnet 7, of every class.
  const Roio::Interest interest{own, (1UL << 0) | (1UL << 7), {0x0F}, false};
  show(roio.begin(500, 2, 0));
  show(roio.begin(timing, own));
  show(roio.begin(timing, own, Roio::Mode::listen_only));
  show(roio.begin(timing, own, Roio::everything()));
  Roio::Filters filters;
  show(Roio::filtersOf(interest, filters));
  show(roio.begin(timing, own, filters, Roio::Mode::loopback));
  show(roio.changeMode(Roio::Mode::normal));
  show(plain.begin(timing, own));
}

void checkTheCrystal() {
  const Roio::BitTiming timing = Roio::bitTiming<16000000, 125000>();
  uint32_t measured_hz = 0;
  show(listener.checkClock(timing, 16000000, measured_hz));
  Serial.println(measured_hz);
  show(listener.begin(timing, Roio::Address{1, 2}, Roio::everything()));
}

void answer() {
  Roio::Message message;
  if (roio.receive(message) == Roio::Status::ok && !message.isBroadcast()) {
    message.setDestination(message.source());
    message.setPriority(message.isUrgent() ? Roio::Priority::urgent : Roio::Priority::normal);
    if (message.length() == 0) {
      message.setLength(1);
      message.data()[0] = message.destination().node;
    }
    show(roio.send(message));
  }
  const uint8_t stop[] = {0};
  show(plain.send(Roio::Message(Roio::everybody(0), stop, sizeof stop, Roio::Priority::urgent)));
}

void passOn() {
  Roio::Frame frame;
  if (listener.receive(frame) == Roio::Status::ok && frame.kind == Roio::FrameKind::standard) {
    show(listener.send(frame));
  }
}

void diagnose() {
  const auto& counters = roio.counters();
  Serial.println(counters.received);
  Serial.println(roio.fetched());
  Serial.println(roio.waiting());
  uint8_t transmit = 0;
  uint8_t receive = 0;
  roio.errorCounters(transmit, receive);
  Serial.println(transmit + receive);
  if (roio.state() == Roio::State::bus_off) {
    Serial.println(F("bus-off"));
  }
}

void setup() {
  Serial.begin(115200);
  beginEachWay();
  checkTheCrystal();
}

void loop() {
  if (roio.poll() == Roio::Status::no_chip || !roio.running()) {
    beginEachWay();
  }
  answer();
  passOn();
  diagnose();
}
