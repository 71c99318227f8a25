#include "bus/wire_bits.hpp"

#include <roio/frame_length.hpp>

namespace roio::sim {
namespace {

/// Appends bits and stuffs them.
class Writer {
 public:
  explicit Writer(WireBits& out) : out_(out) {}

  void put(std::uint32_t value, int width) {
    while (width-- > 0) {
      put_bit((value >> width) & 1U);
    }
  }

  /// The next bit is the last of the arbitration field.
  void end_arbitration() { out_.arbitration_end = out_.size; }

 private:
  void append(std::uint8_t bit) {
    run_ = bit == last_ ? run_ + 1 : 1;
    last_ = bit;
    out_.bits.at(out_.size++) = bit;
  }

  // Five equal bits are followed by their opposite, which counts as the first of the next five.
  void put_bit(std::uint32_t bit) {
    append(static_cast<std::uint8_t>(bit));
    if (run_ == 5) {
      append(last_ ^ 1U);
    }
  }

  WireBits& out_;
  int run_ = 0;
  std::uint8_t last_ = 2;  // none yet
};

void put_head(Writer& writer, const Frame& frame) {
  const std::uint32_t remote = is_remote(frame.kind) ? 1 : 0;
  if (is_extended(frame.kind)) {
    writer.put(frame.id >> 18, 12);  // start of frame and identifier 28..18
    writer.put(0b11, 2);             // SRR, IDE
    writer.put(frame.id & 0x3FFFFU, 18);
    writer.end_arbitration();
    writer.put(remote, 1);
    writer.put(0, 2);  // r1, r0
  } else {
    writer.put(frame.id, 12);
    writer.end_arbitration();
    writer.put(remote, 1);
    writer.put(0, 2);  // IDE, r0
  }
  writer.put(frame.length, 4);
}

}  // namespace

WireBits wire_bits_of(const Frame& frame) {
  WireBits result;
  Writer writer(result);
  put_head(writer, frame);
  const int bytes = detail::data_bits(frame.kind, frame.length) / 8;
  for (int i = 0; i < bytes; ++i) {
    writer.put(frame.data[i], 8);
  }
  writer.put(wire_crc(frame), detail::crc_bits);
  return result;
}

}  // namespace roio::sim
