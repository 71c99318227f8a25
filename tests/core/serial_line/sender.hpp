#ifndef ROIO_TESTS_SERIAL_LINE_SENDER_HPP
#define ROIO_TESTS_SERIAL_LINE_SENDER_HPP

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <roio/serial_protocol.hpp>

namespace roio::test {

/// Of a record. Also a Writer, for what serial_protocol.hpp writes.
struct Body {
  void put(std::uint8_t byte) { bytes[length++] = byte; }
  void put16(std::uint16_t value) {
    put(static_cast<std::uint8_t>(value >> 8));
    put(static_cast<std::uint8_t>(value));
  }
  void put32(std::uint32_t value) {
    put16(static_cast<std::uint16_t>(value >> 16));
    put16(static_cast<std::uint16_t>(value));
  }

  [[nodiscard]] bool is_control() const { return serial::is_control(bytes[0]); }
  [[nodiscard]] bool is(serial::Up operation) const {
    return bytes[0] == static_cast<std::uint8_t>(operation);
  }
  friend bool operator==(const Body& a, const Body& b) {
    return a.length == b.length &&
           std::equal(a.bytes.begin(), a.bytes.begin() + a.length, b.bytes.begin());
  }

  std::array<std::uint8_t, serial::max_body> bytes{};
  std::uint8_t length = 0;
};

struct Sent {
  Body body;
  std::uint32_t frames_before;  ///< All that were due, whether or not they were sent.
};

/// What a bridge sends up: frames of any kind, numbered, some of which find no room and so are only
/// numbered; among them control records.
class Sender {
 public:
  explicit Sender(std::mt19937& random) : random_(random) {}

  Sent next();
  Sent status();
  [[nodiscard]] std::uint32_t due() const { return due_; }

 private:
  Body begin(serial::Up operation);
  Sent frame();
  Sent results();
  Sent counters();
  Sent echoed();
  Sent sent(const Body& body) const { return {body, due_}; }

  std::mt19937& random_;
  std::uint32_t due_ = 0;
  std::uint32_t time_ = 0;
};

}  // namespace roio::test

#endif
