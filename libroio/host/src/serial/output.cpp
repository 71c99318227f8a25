#include "serial/output.hpp"

#include <algorithm>
#include <array>

namespace roio::serial {
namespace {

// Optiboot writes to the flash when it sees this byte where it expects a command: an Uno that has
// just been reset may find the middle of a HELLO there.
constexpr std::uint8_t boot_loader_write = 0x64;

struct Record {
  std::array<std::uint8_t, max_record> bytes{};

  void put(std::uint8_t offset, std::uint8_t byte) { bytes.at(offset) = byte; }
};

}  // namespace

template <typename Body>
void Output::put(std::uint32_t session, const Body& body) {
  Record record;
  RecordWriter<Record> writer(record, session);
  body(writer);
  const std::uint8_t length = writer.finish();
  bytes_.insert(bytes_.end(), record.bytes.begin(), record.bytes.begin() + length);
}

void Output::consume(std::size_t count) {
  bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(count));
}

void Output::put_delimiter() {
  bytes_.push_back(delimiter);
}

void Output::put_hello(std::uint32_t session) {
  put(no_session, [session](auto& writer) {
    writer.put(static_cast<std::uint8_t>(Down::hello));
    writer.put(0);
    writer.put(protocol_version);
    writer.put32(session);
  });
}

void Output::put_control(std::uint32_t session, Down operation, std::uint8_t sequence,
                         std::span<const std::uint8_t> payload) {
  put(session, [&](auto& writer) {
    writer.put(static_cast<std::uint8_t>(operation));
    writer.put(sequence);
    for (const std::uint8_t byte : payload) {
      writer.put(byte);
    }
  });
}

void Output::put_numbered(std::uint32_t session, Down operation, std::uint8_t sequence,
                          std::uint8_t number, std::span<const std::uint8_t> payload) {
  std::vector<std::uint8_t> numbered{number};
  numbered.insert(numbered.end(), payload.begin(), payload.end());
  put_control(session, operation, sequence, numbered);
}

void Output::put_frame(std::uint32_t session, const Frame& frame, std::uint8_t sequence,
                       std::uint8_t life) {
  put(session, [&](auto& writer) { put_frame_down(writer, frame, sequence, life); });
}

bool hello_is_harmful(std::uint32_t session) {
  Output hello;
  hello.put_hello(session);
  return std::ranges::count(hello.bytes(), boot_loader_write) != 0;
}

}  // namespace roio::serial
