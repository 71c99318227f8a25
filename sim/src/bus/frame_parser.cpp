#include "bus/frame_parser.hpp"

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

}  // namespace

void FrameParser::start() {
  *this = FrameParser();
  layout_at_ = ide_at + 1;
}

// Called twice: with IDE, and with the whole DLC.
void FrameParser::note_layout() {
  if (dlc_at_ == 0) {
    dlc_at_ = extended() ? extended_dlc_at : standard_dlc_at;
    layout_at_ = dlc_at_ + dlc_width;
    return;
  }
  const std::uint32_t bytes =
      remote() ? 0 : std::min<std::uint32_t>(field(dlc_at_, dlc_width), max_data_length);
  end_ = static_cast<std::uint8_t>(position_ + 8 * bytes + crc_width);
}

bool FrameParser::extended() const {
  return field(ide_at, 1) != 0;
}

bool FrameParser::remote() const {
  return field(extended() ? extended_rtr_at : standard_rtr_at, 1) != 0;
}

std::uint32_t FrameParser::field(unsigned first, unsigned width) const {
  std::uint32_t value = 0;
  for (unsigned i = first; i < first + width; ++i) {
    const std::uint64_t word = words_.at(i / word_bits);
    value = value << 1 | ((word >> (word_bits - 1U - i % word_bits)) & 1U);
  }
  return value;
}

Frame FrameParser::frame() const {
  Frame frame{};
  frame.id = field(id_at, 11);
  if (extended()) {
    frame.id = frame.id << 18 | field(id_extension_at, 18);
  }
  frame.kind = extended() ? (remote() ? FrameKind::extended_remote : FrameKind::extended)
                          : (remote() ? FrameKind::standard_remote : FrameKind::standard);
  frame.length = static_cast<std::uint8_t>(field(dlc_at_, dlc_width));
  const unsigned bytes = remote() ? 0 : std::min<unsigned>(frame.length, max_data_length);
  for (unsigned i = 0; i < bytes; ++i) {
    frame.data[i] = static_cast<std::uint8_t>(field(dlc_at_ + dlc_width + 8 * i, 8));
  }
  return frame;
}

}  // namespace roio::sim
