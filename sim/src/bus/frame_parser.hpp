#ifndef ROIO_SIM_FRAME_PARSER_HPP
#define ROIO_SIM_FRAME_PARSER_HPP

#include <array>
#include <cstdint>
#include <roio/frame.hpp>

namespace roio::sim {

/// What a receiver makes of the bits from start-of-frame to the end of the CRC, one at a time:
/// takes out the stuff bits and checks the CRC. Holds no more than one frame; no heap.
class FrameParser {
 public:
  enum class Step : std::uint8_t {
    more,         ///< Taken; the frame goes on.
    stuff_error,  ///< The sixth equal bit.
    complete,     ///< That was the last bit (or stuff bit) of the CRC.
  };

  void start();
  // Inline, for it is what a simulation spends its time in.
  Step put(std::uint8_t bit) {
    const bool stuff_bit = expects_stuff_bit();
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
    return position_ == end_ && !expects_stuff_bit() ? Step::complete : Step::more;
  }

  /// Whether the next bit is a stuff bit.
  [[nodiscard]] bool expects_stuff_bit() const { return run_ == 5; }

  /// After complete.
  [[nodiscard]] bool crc_matches() const { return crc_ == 0; }
  /// After complete; length is the DLC as it came, 0..15, and data past it are 0.
  [[nodiscard]] Frame frame() const;

 private:
  static constexpr std::uint16_t crc_polynomial = 0x4599;  // x15+x14+x10+x8+x7+x4+x3+1
  static constexpr std::uint8_t word_bits = 64;

  void take(std::uint8_t bit) {
    words_[position_ / word_bits] |= std::uint64_t{bit} << (word_bits - 1U - position_ % word_bits);
    const auto feedback = static_cast<std::uint16_t>(((crc_ >> 14) ^ bit) & 1U);
    crc_ = static_cast<std::uint16_t>(((crc_ << 1) & 0x7FFF) ^ (feedback * crc_polynomial));
    if (++position_ == layout_at_) {
      note_layout();
    }
  }
  void note_layout();
  [[nodiscard]] bool extended() const;
  [[nodiscard]] bool remote() const;
  [[nodiscard]] std::uint32_t field(unsigned first, unsigned width) const;

  std::array<std::uint64_t, 2> words_{};  // the bits without stuff bits, the first one highest
  std::uint8_t position_ = 0;             // how many are there
  std::uint8_t layout_at_ = 0;            // when there are this many, more is known of the layout
  std::uint8_t end_ = 0;                  // how many there will be; 0: not known yet
  std::uint8_t dlc_at_ = 0;               // where the DLC begins
  std::uint8_t run_ = 0;                  // equal bits up to now
  std::uint8_t last_ = 2;                 // 2: none yet
  std::uint16_t crc_ = 0;                 // 0 once the frame's own CRC has gone through it, too
};

}  // namespace roio::sim

#endif
