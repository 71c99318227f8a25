/// Frames, and levels of the wire, as text that a failing test can show.
#ifndef ROIO_TESTS_WIRE_TEXT_HPP
#define ROIO_TESTS_WIRE_TEXT_HPP

#include <cstdint>
#include <cstdio>
#include <random>
#include <roio/frame.hpp>
#include <string>
#include <vector>

#include "bus/wire_bits.hpp"
#include "seed.hpp"

namespace roio::test {

/// "1000400A x8 DLC 3 5A 2D 00": identifier, kind ("std", "std remote", ...), DLC and data.
inline std::string text_of(const Frame& frame) {
  char buffer[16];
  std::snprintf(buffer, sizeof buffer, is_extended(frame.kind) ? "%08X" : "%03X", frame.id);
  std::string text = buffer;
  text += is_remote(frame.kind) ? " remote " : " ";
  text += "DLC " + std::to_string(frame.length);
  for (int i = 0; i < frame.length && i < max_data_length && !is_remote(frame.kind); ++i) {
    std::snprintf(buffer, sizeof buffer, " %02X", frame.data[i]);
    text += buffer;
  }
  return text;
}

inline std::vector<std::string> text_of(const std::vector<Frame>& frames) {
  std::vector<std::string> texts;
  texts.reserve(frames.size());
  for (const Frame& frame : frames) {
    texts.push_back(text_of(frame));
  }
  return texts;
}

/// A frame's bits as the transmitter sends them, from start-of-frame to the end of the CRC.
inline std::string wire_text(const Frame& frame) {
  const sim::WireBits wire = sim::wire_bits_of(frame);
  std::string text;
  for (std::size_t i = 0; i < wire.size; ++i) {
    text += wire.bits.at(i) == 0 ? '0' : '1';
  }
  return text;
}

/// The digits 0 and 1 of a text that has spaces and brackets in it, too.
inline std::string digits_of(const std::string& text) {
  std::string digits;
  for (const char c : text) {
    if (c == '0' || c == '1') {
      digits += c;
    }
  }
  return digits;
}

/// Any kind, any DLC from 0 to 15; half of them made of long runs of equal bits.
inline Frame random_frame(std::mt19937& generator) {
  constexpr FrameKind kinds[] = {FrameKind::standard, FrameKind::standard_remote,
                                 FrameKind::extended, FrameKind::extended_remote};
  constexpr std::uint8_t run_bytes[] = {0x00, 0xFF, 0x0F, 0xF0, 0x1F, 0xF8, 0x83, 0x7C};
  Frame frame{};
  frame.kind = kinds[up_to(generator, 3)];
  frame.length = static_cast<std::uint8_t>(up_to(generator, 15));
  const bool runs = up_to(generator, 1) == 0;
  const auto byte = [&] {
    return runs ? run_bytes[up_to(generator, 7)] : static_cast<std::uint8_t>(up_to(generator, 255));
  };
  for (std::uint8_t& data : frame.data) {
    data = byte();
  }
  for (int i = 0; i < 4; ++i) {
    frame.id = (frame.id << 8) | byte();
  }
  frame.id &= max_id(frame.kind);
  return frame;
}

}  // namespace roio::test

#endif
