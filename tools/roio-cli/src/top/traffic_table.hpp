/// TrafficTable: who says what to whom on a bus, and how often. Pure: frames and the time go in,
/// rows come out. A frame costs a look-up and its length in bits; all else is done by tick(), once
/// an interval.
#ifndef ROIO_CLI_TRAFFIC_TABLE_HPP
#define ROIO_CLI_TRAFFIC_TABLE_HPP

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <roio/bus.hpp>
#include <unordered_map>
#include <vector>

#include "form/labels.hpp"
#include "top/load_meter.hpp"

namespace roio::cli {

/// One message of one sender to one receiver: frames of one identifier, length and variant
/// (Labels). What is no message has rows, too.
struct TrafficRow {
  Frame last{};              ///< The latest of them.
  std::uint64_t frames = 0;  ///< So many have come.
  std::uint64_t bits = 0;    ///< On the wire, all together.
  std::uint8_t changed = 0;  ///< Bit i: byte i changed in the last interval in which any came.
  Timestamp time{};          ///< When the last one was on the bus.
  Timeout age{};             ///< Since then.
  double rate = 0;           ///< Frames a second; 0: only one has come yet, or it is silent.
  bool silent = false;       ///< More than two seconds and three of its periods have gone by.
};

class TrafficTable {
 public:
  /// Rows there is room for; frames of any others are counted in rowless().
  static constexpr std::size_t max_rows = 2048;

  explicit TrafficTable(const Labels& labels) : labels_(labels) {}

  /// A frame that was received; error reports are passed over.
  void add(const Received& received);
  /// An interval ends: works out rates, ages and what has changed.
  void tick(Timestamp now);
  /// Forgets rows and counts, as if nothing had come.
  void clear();

  /// In the order in which they first came; as of the last tick().
  [[nodiscard]] std::vector<TrafficRow> rows() const;
  [[nodiscard]] std::uint64_t frames() const { return frames_; }
  [[nodiscard]] std::uint64_t rowless() const { return rowless_; }
  [[nodiscard]] LoadMeter& meter() { return meter_; }
  [[nodiscard]] const LoadMeter& meter() const { return meter_; }

 private:
  struct Entry {
    TrafficRow row;
    std::uint8_t fresh_changes = 0;  // since the last tick()
    std::uint64_t fresh_frames = 0;  // the same
    // row.time and row.frames as they once were: the rate is what has come since.
    Timestamp counted_time{};
    std::uint64_t counted_frames = 0;
    double period_rate = 0;  // the rate, also while it is silent
    bool settled = false;    // it is taken from a second at least
  };

  Entry* find(const Frame& frame);
  static void count(Entry& entry, const Received& received);
  static void tick(Entry& entry, Timestamp now);
  static void rate(Entry& entry);

  const Labels& labels_;
  std::vector<Entry> entries_;
  std::unordered_map<std::uint64_t, std::size_t> index_;  // of entries_, by what makes a row
  std::uint64_t frames_ = 0;
  std::uint64_t rowless_ = 0;
  LoadMeter meter_;
};

}  // namespace roio::cli

#endif
