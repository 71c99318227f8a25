#include "sender.hpp"

#include "seed.hpp"

namespace roio::test {
namespace {

constexpr std::array kinds = {FrameKind::standard, FrameKind::standard_remote, FrameKind::extended,
                              FrameKind::extended_remote};

}  // namespace

Sent Sender::next() {
  time_ += up_to(random_, 200);
  if (up_to(random_, 2'000) == 0) {
    due_ += up_to(random_, 600);  // no room
  }
  switch (up_to(random_, 63)) {
    case 0:
    case 1:
      return status();
    case 2:
      return results();
    case 3:
      return counters();
    case 4:
      return echoed();
    default:
      return frame();
  }
}

Sent Sender::status() {
  Body body = begin(serial::Up::status);
  body.put32(time_);
  body.put32(due_);
  body.put(0);
  body.put(static_cast<std::uint8_t>(random_()));
  body.put(static_cast<std::uint8_t>(random_()));
  return sent(body);
}

Body Sender::begin(serial::Up operation) {
  Body body;
  body.put(static_cast<std::uint8_t>(operation));
  body.put(static_cast<std::uint8_t>(due_));
  return body;
}

Sent Sender::frame() {
  const FrameKind kind = kinds[up_to(random_, kinds.size() - 1)];
  Body body;
  body.put32(tagged_id(kind, up_to(random_, max_id(kind))));
  body.put(static_cast<std::uint8_t>(due_));
  body.put16(static_cast<std::uint16_t>(time_));
  // A zero one time in four: COBS has more blocks then.
  std::array<std::uint8_t, max_data_length> data{};
  std::uint32_t zeros = up_to(random_, 0xFFFF);
  for (std::uint8_t& byte : data) {
    byte = static_cast<std::uint8_t>(zeros % 4 == 0 ? 0 : random_());
    zeros /= 4;
  }
  serial::put_payload(body, kind, static_cast<std::uint8_t>(up_to(random_, 8)), data.data());
  const Sent result = sent(body);
  ++due_;
  return result;
}

Sent Sender::results() {
  Body body = begin(serial::Up::results);
  body.put(static_cast<std::uint8_t>(random_()));
  body.put(0);
  body.put32(static_cast<std::uint32_t>(random_()));
  return sent(body);
}

Sent Sender::counters() {
  Body body = begin(serial::Up::counters);
  body.put(0);
  for (std::uint8_t i = 0; i < serial::counters_at_once; ++i) {
    body.put32(up_to(random_, 1'000));
  }
  return sent(body);
}

Sent Sender::echoed() {
  Body body = begin(serial::Up::echoed);
  for (std::uint32_t count = up_to(random_, serial::max_echo); count > 0; --count) {
    body.put(static_cast<std::uint8_t>(random_()));
  }
  return sent(body);
}

}  // namespace roio::test
