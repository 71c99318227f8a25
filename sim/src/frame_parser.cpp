#include "frame_parser.hpp"

#include <algorithm>

namespace roio::sim {
namespace {

// Positions without stuff bits, from 0; ISO 11898-1 frame formats.
//   standard:  0 SOF | 1..11 id | 12 RTR | 13 IDE | 14 r0 | 15..18 DLC | data | CRC
//   extended:  0 SOF | 1..11 id | 12 SRR | 13 IDE | 14..31 id | 32 RTR | 33 r1 | 34 r0 | 35..38 DLC
constexpr std::uint8_t id_at = 1;
constexpr std::uint8_t standard_rtr_at = 12;
constexpr std::uint8_t ide_at = 13;
constexpr std::uint8_t id_extension_at = 14;
constexpr std::uint8_t extended_rtr_at = 32;
constexpr std::uint8_t standard_dlc_at = 15;
constexpr std::uint8_t extended_dlc_at = 35;
constexpr std::uint8_t dlc_width = 4;
constexpr std::uint8_t crc_width = 15;
constexpr std::uint16_t crc_polynomial = 0x4599;  // x15+x14+x10+x8+x7+x4+x3+1

}  // namespace

void FrameParser::start() {
  position_ = 0;
  end_ = 0;
  dlc_at_ = 0;
  run_ = 0;
  last_ = 2;
  crc_ = 0;
}

FrameParser::Step FrameParser::put(std::uint8_t bit) {
  const bool stuff_bit = run_ == 5;
  if (bit != last_) {
    last_ = bit;
    run_ = 1;
  } else if (stuff_bit) {
    return Step::stuff_error;
  } else {
    ++run_;
  }
  if (!stuff_bit) {
    take(bit);
  }
  // Five equal bits at the very end of the CRC are followed by a stuff bit, too.
  return position_ == end_ && run_ != 5 ? Step::complete : Step::more;
}

void FrameParser::take(std::uint8_t bit) {
  bits_[position_++] = bit;
  const bool feedback = ((crc_ >> 14) & 1U) != bit;
  crc_ = static_cast<std::uint16_t>((crc_ << 1) & 0x7FFF);
  if (feedback) {
    crc_ ^= crc_polynomial;
  }
  if (end_ == 0) {
    note_layout();
  }
}

void FrameParser::note_layout() {
  if (position_ == ide_at + 1) {
    dlc_at_ = bits_[ide_at] != 0 ? extended_dlc_at : standard_dlc_at;
  } else if (dlc_at_ != 0 && position_ == dlc_at_ + dlc_width) {
    const bool extended = bits_[ide_at] != 0;
    const bool remote = bits_[extended ? extended_rtr_at : standard_rtr_at] != 0;
    const std::uint32_t bytes =
        remote ? 0 : std::min<std::uint32_t>(field(dlc_at_, dlc_width), max_data_length);
    end_ = static_cast<std::uint8_t>(position_ + 8 * bytes + crc_width);
  }
}

std::uint32_t FrameParser::field(std::uint8_t first, std::uint8_t width) const {
  std::uint32_t value = 0;
  for (std::uint8_t i = 0; i < width; ++i) {
    value = value << 1 | bits_.at(first + i);
  }
  return value;
}

Frame FrameParser::frame() const {
  Frame frame{};
  const bool extended = bits_[ide_at] != 0;
  const bool remote = bits_[extended ? extended_rtr_at : standard_rtr_at] != 0;
  frame.id = field(id_at, 11);
  if (extended) {
    frame.id = frame.id << 18 | field(id_extension_at, 18);
  }
  frame.kind = extended ? (remote ? FrameKind::extended_remote : FrameKind::extended)
                        : (remote ? FrameKind::standard_remote : FrameKind::standard);
  frame.length = static_cast<std::uint8_t>(field(dlc_at_, dlc_width));
  const int bytes = remote ? 0 : std::min<int>(frame.length, max_data_length);
  for (int i = 0; i < bytes; ++i) {
    frame.data[i] =
        static_cast<std::uint8_t>(field(static_cast<std::uint8_t>(dlc_at_ + dlc_width + 8 * i), 8));
  }
  return frame;
}

}  // namespace roio::sim
