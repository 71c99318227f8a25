/// LoadMeter: how busy a bus is, from when its frames were on it and how long they were. Pure:
/// frames and the time go in. Time is kept in bins of a tenth of a second by the frames' own time
/// stamps, so that it does not matter when somebody came to read them.
#ifndef ROIO_CLI_LOAD_METER_HPP
#define ROIO_CLI_LOAD_METER_HPP

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <roio/bus.hpp>

namespace roio::cli {

struct Load {
  double frames_per_s = 0;      ///< Of the last whole second.
  double bits_per_s = 0;        ///< The same in bits on the wire.
  double peak_bits_per_s = 0;   ///< Of the busiest second so far.
  std::optional<double> share;  ///< 0..1, of the bit rate; none: that is not known.
  std::optional<double> peak_share;
};

class LoadMeter {
 public:
  static constexpr std::chrono::milliseconds bin_time{100};

  /// Of the bus, when it is known. With another one it begins anew, without the peak.
  void set_bitrate(std::optional<std::uint32_t> bitrate_bps);
  [[nodiscard]] std::optional<std::uint32_t> bitrate() const { return bitrate_bps_; }

  /// @param time when the frame was on the bus. A frame that comes later than others by more than
  ///        a second counts to the oldest bin that is still open, never to none.
  void add(Timestamp time, unsigned bits);
  /// Bins that ended before the last one that `now` has ended are complete, and count.
  void advance(Timestamp now);
  [[nodiscard]] Load load() const;
  void clear();

 private:
  static constexpr std::int64_t bins_a_second = 10;
  // The current one, and the one before, of which frames may still be on their way to us.
  static constexpr std::int64_t open_bins = 2;

  struct Bin {
    double bits = 0;
    std::int64_t frames = 0;
  };

  Bin& bin(std::int64_t number) { return bins_[static_cast<std::size_t>(number) % bins_.size()]; }
  void reach(std::int64_t number);
  void start(std::int64_t number);
  void complete(std::int64_t number);
  [[nodiscard]] double bits_per_s() const;

  std::array<Bin, 16> bins_{};          // a power of two above all that are summed up or open
  std::optional<std::int64_t> newest_;  // none: nothing has happened yet
  std::int64_t complete_ = 0;           // bins of the last second that are, 10 at most
  Bin second_{};                        // their sum
  double peak_bits_per_s_ = 0;
  std::optional<std::uint32_t> bitrate_bps_;
};

}  // namespace roio::cli

#endif
