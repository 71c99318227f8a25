#include "top/traffic_table.hpp"

#include <algorithm>
#include <roio/frame_length.hpp>

namespace roio::cli {
namespace {

constexpr Timeout silent_after = std::chrono::seconds(2);
constexpr double silent_periods = 3;

// A rate is taken anew once so much time lies between the frames that it is taken from.
constexpr Timeout rate_time = std::chrono::seconds(1);

double seconds(Timeout time) {
  return std::chrono::duration<double>(time).count();
}

std::uint8_t changes(const Frame& before, const Frame& after) {
  std::uint8_t mask = 0;
  for (std::uint8_t i = 0; i < after.length && !is_remote(after.kind); ++i) {
    mask |= static_cast<std::uint8_t>((before.data[i] != after.data[i] ? 1U : 0U) << i);
  }
  return mask;
}

}  // namespace

void TrafficTable::add(const Received& received) {
  Frame frame = received.frame;
  if (frame.kind == FrameKind::error) {
    return;
  }
  frame.length = std::min(frame.length, max_data_length);
  const unsigned bits = wire_bits(frame);
  ++frames_;
  meter_.add(received.time, bits);
  Entry* const entry = find(frame);
  if (entry == nullptr) {
    ++rowless_;
    return;
  }
  entry->row.bits += bits;
  if (entry->row.frames > 0) {
    entry->fresh_changes |= changes(entry->row.last, frame);
  }
  count(*entry, {frame, received.time, received.lost_before});
}

void TrafficTable::count(Entry& entry, const Received& received) {
  TrafficRow& row = entry.row;
  ++entry.fresh_frames;
  ++row.frames;
  row.last = received.frame;
  row.time = received.time;
  // What was silent begins anew: the time of its silence says nothing of its rate.
  const bool comes_back = row.silent && entry.period_rate > 0;
  if (row.frames == 1 || comes_back) {
    entry.counted_time = row.time;
    entry.counted_frames = row.frames;
    entry.settled = false;
  }
  row.silent = false;
}

TrafficTable::Entry* TrafficTable::find(const Frame& frame) {
  // identifier and kind | length | variant
  const std::uint64_t key = std::uint64_t{tagged_id(frame)} << 32 |
                            std::uint64_t{frame.length} << 28 |
                            (labels_.variant(frame) & 0x0FFFFFFFU);
  const auto found = index_.find(key);
  if (found != index_.end()) {
    return &entries_[found->second];
  }
  if (entries_.size() == max_rows) {
    return nullptr;
  }
  index_.emplace(key, entries_.size());
  return &entries_.emplace_back();
}

void TrafficTable::tick(Timestamp now) {
  meter_.advance(now);
  for (Entry& entry : entries_) {
    tick(entry, now);
  }
}

void TrafficTable::tick(Entry& entry, Timestamp now) {
  TrafficRow& row = entry.row;
  row.age = std::max<Timeout>(now - row.time, no_wait);
  if (entry.fresh_frames > 0) {
    row.changed = entry.fresh_changes;
    entry.fresh_changes = 0;
    entry.fresh_frames = 0;
  }
  rate(entry);
  const bool is_late =
      entry.period_rate == 0 || seconds(row.age) * entry.period_rate > silent_periods;
  row.silent = row.age > silent_after && is_late;
  row.rate = row.silent ? 0 : entry.period_rate;
}

void TrafficTable::rate(Entry& entry) {
  const TrafficRow& row = entry.row;
  const Timeout counted_for = row.time - entry.counted_time;
  const bool went_back = counted_for < no_wait;  // the clock was set
  if (!went_back && counted_for > no_wait && (counted_for >= rate_time || !entry.settled)) {
    entry.period_rate =
        static_cast<double>(row.frames - entry.counted_frames) / seconds(counted_for);
  }
  if (went_back || counted_for >= rate_time) {
    entry.counted_time = row.time;
    entry.counted_frames = row.frames;
    entry.settled = true;
  }
}

void TrafficTable::clear() {
  entries_.clear();
  index_.clear();
  frames_ = 0;
  rowless_ = 0;
  meter_.clear();
}

std::vector<TrafficRow> TrafficTable::rows() const {
  std::vector<TrafficRow> rows;
  rows.reserve(entries_.size());
  for (const Entry& entry : entries_) {
    rows.push_back(entry.row);
  }
  return rows;
}

}  // namespace roio::cli
