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
  Step put(std::uint8_t bit);

  /// Whether the next bit is a stuff bit.
  [[nodiscard]] bool expects_stuff_bit() const { return run_ == 5; }

  /// After complete.
  [[nodiscard]] bool crc_matches() const { return crc_ == 0; }
  /// After complete; length is the DLC as it came, 0..15, and data past it are 0.
  [[nodiscard]] Frame frame() const;

 private:
  void take(std::uint8_t bit);
  void note_layout();
  [[nodiscard]] std::uint32_t field(std::uint8_t first, std::uint8_t width) const;

  std::array<std::uint8_t, 118> bits_{};  // without stuff bits
  std::uint8_t position_ = 0;             // how many of bits_ are there
  std::uint8_t end_ = 0;                  // how many there will be; 0: not known yet
  std::uint8_t dlc_at_ = 0;               // where the DLC begins
  std::uint8_t run_ = 0;                  // equal bits up to now
  std::uint8_t last_ = 2;                 // 2: none yet
  std::uint16_t crc_ = 0;                 // 0 once the frame's own CRC has gone through it, too
};

}  // namespace roio::sim

#endif
