#ifndef ROIO_TESTS_SERIAL_LINE_LINE_HPP
#define ROIO_TESTS_SERIAL_LINE_LINE_HPP

#include <array>
#include <cstdint>
#include <optional>
#include <random>
#include <span>
#include <vector>

namespace roio::test {

/// What a line does to bytes; docs/internals/serial-protocol.md counts on none of it to be rare.
enum class Fault : std::uint8_t {
  flipped,         ///< 1..3 bits of a byte.
  replaced,        ///< A byte by another.
  zeroed,          ///< A byte by a delimiter.
  lost,            ///< A byte.
  made_up,         ///< 1..4 bytes, of any value.
  made_up_zero,    ///< A delimiter.
  repeated,        ///< A byte, once more.
  swapped,         ///< A byte and the next.
  lost_delimiter,  ///< The next that comes.
  noise,           ///< 3..40 bytes in a row, all of them changed.
  overrun,         ///< 2..100 bytes in a row, lost.
  outage,          ///< 6,000..30,000 bytes, lost: more than 256 records.
};
constexpr std::size_t fault_count = 12;

/// Noise of 3..5 bytes is the worst for a check: it often leaves COBS whole, and what is wider than
/// the check is found by chance only.
enum class Mix : std::uint8_t { everything, noise };

/// A line that damages about half of the records of a stream.
class Line {
 public:
  Line(Mix mix, std::mt19937& random);

  /// @param arrived what comes out of the line is added to it.
  /// @return whether all bytes came through, and nothing between them.
  bool carry(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& arrived);
  /// No faults any more.
  void calm_down();

  /// Whether the last byte that came out, if any, was a delimiter.
  [[nodiscard]] bool is_in_step() const { return last_ == 0; }
  [[nodiscard]] const std::array<std::uint64_t, fault_count>& faults() const { return faults_; }

 private:
  void pass(std::uint8_t byte);
  void strike(std::uint8_t byte);
  void put(std::uint8_t byte);
  void put_flipped(std::uint8_t byte);
  [[nodiscard]] std::uint8_t any_byte();
  void plan();

  Mix mix_;
  std::mt19937& random_;
  std::vector<std::uint8_t>* arrived_ = nullptr;
  bool is_calm_ = false;
  bool whole_ = true;           // what is being carried, so far
  std::uint32_t fault_in_ = 0;  // bytes
  std::uint32_t losing_ = 0;    // bytes to come
  std::uint32_t changing_ = 0;  // bytes to come
  bool loses_delimiter_ = false;
  std::optional<std::uint8_t> held_;  // until the next has gone
  std::uint8_t last_ = 0;
  std::array<std::uint64_t, fault_count> faults_{};
};

}  // namespace roio::test

#endif
