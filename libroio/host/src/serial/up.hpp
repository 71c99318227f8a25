#ifndef ROIO_SERIAL_UP_HPP
#define ROIO_SERIAL_UP_HPP

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace roio::serial {

/// Which frames from the bridge have come, and how many have not: by their sequence, modulo 256,
/// and by the bridge's own count of those that were due, modulo 2^32.
class UpCount {
 public:
  /// Another session. What it missed since the one before is for the caller to say: lose().
  void begin() { next_ = 0; }

  /// A record says that the next frame has this sequence: those before it that have not come are
  /// lost.
  void expect(std::uint8_t sequence) {
    lose(static_cast<std::uint8_t>(sequence - static_cast<std::uint8_t>(next_)));
  }
  /// A frame of this sequence has come.
  void take(std::uint8_t sequence) {
    expect(sequence);
    ++next_;
  }
  /// The bridge says how many frames were due so far.
  /// @return false: fewer than are known of, so it cannot be; nothing was changed.
  bool settle(std::uint32_t due) {
    const auto missing = static_cast<std::int32_t>(due - static_cast<std::uint32_t>(next_));
    if (missing < 0) {
      return false;
    }
    lose(static_cast<std::uint32_t>(missing));
    return true;
  }

  [[nodiscard]] std::uint64_t lost() const { return lost_; }

 private:
  void lose(std::uint32_t count) {
    lost_ += count;
    next_ += count;
  }

  std::uint64_t next_ = 0;  // of this session
  std::uint64_t lost_ = 0;  // of all sessions
};

/// Tells a record that the line repeats from a frame with the same sequence, 256 frames later: it
/// is one of the last 16, byte for byte, the time included. For that to be another frame, 240 of
/// the 255 in between would have to be lost, and it to be read from the controller a multiple of
/// 262.144 ms later, to 4 us.
class RepeatedFrames {
 public:
  /// Another session.
  void begin() { last_ = {}; }
  /// @param body of a frame from the bridge. @return whether it has come before.
  bool take(std::span<const std::uint8_t> body) {
    if (std::ranges::any_of(last_,
                            [&](const auto& one) { return std::ranges::equal(one, body); })) {
      return true;
    }
    last_[next_].assign(body.begin(), body.end());
    next_ = (next_ + 1) % last_.size();
    return false;
  }

 private:
  static constexpr std::size_t remembered = 16;
  std::array<std::vector<std::uint8_t>, remembered> last_;
  std::size_t next_ = 0;
};

}  // namespace roio::serial

#endif
