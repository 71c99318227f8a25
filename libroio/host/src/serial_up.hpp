#ifndef ROIO_SERIAL_UP_HPP
#define ROIO_SERIAL_UP_HPP

#include <cstdint>

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

}  // namespace roio::serial

#endif
