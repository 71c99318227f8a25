/// How long a frame is on the wire, in bits: exactly (for these very bits), at least and at most.
/// Counted from start-of-frame to the end of the intermission, so a saturated bus carries exactly
/// bitrate / bits frames a second. Source: docs/protocol.md "Frame length"; ISO 11898-1 frame
/// formats.
///
///   part                      standard   extended
///   SOF + arbitration + control     19         39   stuffed
///   data                       0 .. 64    0 .. 64   stuffed
///   CRC-15                          15         15   stuffed
///   CRC delimiter, ACK, EOF         10         10
///   intermission                     3          3
#ifndef ROIO_FRAME_LENGTH_HPP
#define ROIO_FRAME_LENGTH_HPP

#include <stdint.h>

#include <roio/frame.hpp>

namespace roio {

namespace detail {

constexpr uint8_t crc_bits = 15;
constexpr uint16_t crc_polynomial = 0x4599;  ///< x15+x14+x10+x8+x7+x4+x3+1, ISO 11898-1.
constexpr uint8_t unstuffed_bits =
    13;  ///< CRC delimiter, ACK slot and delimiter, EOF, intermission.

constexpr uint8_t head_bits(FrameKind kind) {
  return is_extended(kind) ? 39 : 19;
}
constexpr uint8_t data_bits(FrameKind kind, uint8_t length) {
  return is_remote(kind)            ? 0
         : length < max_data_length ? static_cast<uint8_t>(8U * length)
                                    : static_cast<uint8_t>(8U * max_data_length);
}
constexpr uint8_t stuffed_region_bits(FrameKind kind, uint8_t length) {
  return static_cast<uint8_t>(head_bits(kind) + data_bits(kind, length) + crc_bits);
}

/// Takes the frame's bits one by one as a transmitter would, and counts the stuff bits it would
/// insert.
class StuffCounter {
 public:
  StuffCounter() : crc_(0), stuffed_(0), run_(0), last_(2) {}

  /// The `width` low bits of value, highest first; they go into the CRC.
  void put(uint32_t value, uint8_t width) {
    while (width-- > 0) {
      const uint8_t bit = (value >> width) & 1U;
      const uint8_t feedback = bit ^ static_cast<uint8_t>((crc_ >> 14) & 1U);
      crc_ = static_cast<uint16_t>((unsigned{crc_} << 1) & 0x7FFFU);
      if (feedback) {
        crc_ ^= crc_polynomial;
      }
      stuff(bit);
    }
  }

  /// The CRC itself: stuffed like the rest. Call once, last.
  void put_crc() {
    const uint16_t crc = crc_;
    for (uint8_t shift = crc_bits; shift-- > 0;) {
      stuff((crc >> shift) & 1U);
    }
  }

  uint16_t crc() const { return crc_; }
  uint8_t stuff_bits() const { return stuffed_; }

 private:
  // Five equal bits are followed by their opposite, which itself starts the next run.
  void stuff(uint8_t bit) {
    run_ = bit == last_ ? static_cast<uint8_t>(run_ + 1U) : 1U;
    last_ = bit;
    if (run_ == 5U) {
      ++stuffed_;
      last_ = bit ^ 1U;
      run_ = 1;
    }
  }

  uint16_t crc_;
  uint8_t stuffed_;
  uint8_t run_;
  uint8_t last_;  // 2: no bit yet
};

inline StuffCounter count_stuff_bits(const Frame& frame) {
  const uint32_t remote = is_remote(frame.kind) ? 1U : 0U;
  StuffCounter counter;
  if (is_extended(frame.kind)) {
    counter.put(frame.id >> 18, 12);       // SOF (dominant) and identifier 28..18
    counter.put(3, 2);                     // SRR, IDE: recessive
    counter.put(frame.id & 0x3FFFFU, 18);  // identifier 17..0
    counter.put(remote << 2, 3);           // RTR, r1, r0
  } else {
    counter.put(frame.id & 0x7FFU, 12);  // SOF and identifier
    counter.put(remote << 2, 3);         // RTR, IDE, r0
  }
  counter.put(frame.length, 4);
  const uint8_t bytes = data_bits(frame.kind, frame.length) / 8U;
  for (uint8_t i = 0; i < bytes; ++i) {
    counter.put(frame.data[i], 8);
  }
  counter.put_crc();
  return counter;
}

}  // namespace detail

/// Bits of a frame without any stuff bit: 67 to 131 extended, 47 to 111 standard. No frame is
/// shorter.
/// @param length 0..8; more counts as 8. Remote frames carry no data whatever it is.
constexpr uint8_t shortest_bits(FrameKind kind, uint8_t length) {
  return static_cast<uint8_t>(detail::stuffed_region_bits(kind, length) + detail::unstuffed_bits);
}

/// The worst case to plan with: a stuff bit after the first 5 bits, then after every 4. 80 to 160
/// extended, 55 to 135 standard. No frame is longer; the bits that are the same in every frame keep
/// the longest extended data frame 2 bits below, the longest standard one 1 to 3.
constexpr uint8_t longest_bits(FrameKind kind, uint8_t length) {
  return static_cast<uint8_t>(shortest_bits(kind, length) +
                              (detail::stuffed_region_bits(kind, length) - 1U) / 4U);
}

/// Bits of this very frame, its CRC and stuff bits worked out.
/// @param frame valid; its length above 8 counts as 8 data bytes with that DLC.
/// @return 47..158; 0 for an error report, which never is on the wire.
inline uint8_t wire_bits(const Frame& frame) {
  return frame.kind == FrameKind::error
             ? 0
             : static_cast<uint8_t>(shortest_bits(frame.kind, frame.length) +
                                    detail::count_stuff_bits(frame).stuff_bits());
}

/// The CRC-15 that goes with this frame; 0 for an error report.
inline uint16_t wire_crc(const Frame& frame) {
  return frame.kind == FrameKind::error ? uint16_t{0} : detail::count_stuff_bits(frame).crc();
}

}  // namespace roio

#endif
