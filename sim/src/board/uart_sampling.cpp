#include "board/uart_sampling.hpp"

#include <cmath>
#include <cstddef>

namespace roio::sim {
namespace {

constexpr double most_difference = 0.045;
constexpr std::size_t data_bits = 8;
constexpr std::size_t frame_bits = 10;  // with start and stop bit
// A receiver that looks eight times a bit (U2X) is about that unsure of where a bit began: so much
// that most_difference is just right.
constexpr double unsure = 0.1176;

// A line that sends bytes and then is idle. Time counts the sender's bits.
class Line {
 public:
  explicit Line(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  [[nodiscard]] std::size_t end() const { return bytes_.size() * frame_bits; }
  [[nodiscard]] bool high_at(double time) const {
    return is_high(static_cast<std::size_t>(std::floor(time)));
  }
  /// The first beginning of a low bit after a high one from `time` on; end(): there is none.
  [[nodiscard]] std::size_t falling_edge(double time) const {
    auto bit = static_cast<std::size_t>(std::ceil(time));
    while (bit < end() && (is_high(bit) || (bit > 0 && !is_high(bit - 1)))) {
      ++bit;
    }
    return bit;
  }

 private:
  [[nodiscard]] bool is_high(std::size_t bit) const {
    if (bit >= end()) {
      return true;
    }
    const std::size_t place = bit % frame_bits;
    if (place == 0) {
      return false;
    }
    return place > data_bits || (bytes_[bit / frame_bits] >> (place - 1) & 1) != 0;
  }

  std::span<const std::uint8_t> bytes_;
};

}  // namespace

bool rates_match(double one_bps, double other_bps) {
  return std::abs(one_bps / other_bps - 1) <= most_difference;
}

std::vector<std::uint8_t> sampled(std::span<const std::uint8_t> sent, double sender_bps,
                                  double receiver_bps) {
  const double bit = sender_bps / receiver_bps;  // the receiver's, in the sender's
  const double middle = (bit > 1 ? 0.5 + unsure : 0.5 - unsure) * bit;
  const Line line(sent);
  std::vector<std::uint8_t> heard;
  double from = 0;
  for (std::size_t edge = 0; (edge = line.falling_edge(from)) < line.end();) {
    const auto start = static_cast<double>(edge);
    if (line.high_at(start + middle)) {
      from = start + middle;  // too short for a start bit
      continue;
    }
    unsigned byte = 0;
    for (unsigned i = 0; i < data_bits; ++i) {
      byte |= (line.high_at(start + middle + (i + 1) * bit) ? 1U : 0U) << i;
    }
    heard.push_back(static_cast<std::uint8_t>(byte));
    from = start + (frame_bits - 0.5) * bit;
  }
  return heard;
}

}  // namespace roio::sim
