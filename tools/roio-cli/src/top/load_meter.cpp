#include "top/load_meter.hpp"

#include <algorithm>

namespace roio::cli {
namespace {

std::int64_t number_of(Timestamp time) {
  return std::chrono::floor<std::chrono::milliseconds>(time.time_since_epoch()) /
         LoadMeter::bin_time;
}

double seconds_since_start(Timestamp time, std::int64_t number) {
  return std::chrono::duration<double>(time.time_since_epoch() - number * LoadMeter::bin_time)
      .count();
}

}  // namespace

// A share of another bit rate says nothing of this one.
void LoadMeter::set_bitrate(std::optional<std::uint32_t> bitrate_bps) {
  if (bitrate_bps_ && bitrate_bps && *bitrate_bps_ != *bitrate_bps) {
    clear();
  }
  bitrate_bps_ = bitrate_bps;
}

void LoadMeter::add(Timestamp time, unsigned bits) {
  std::int64_t number = number_of(time);
  if (!newest_) {
    start(number);
  }
  reach(number);
  const std::int64_t oldest = *newest_ - open_bins + 1;
  if (number < oldest) {
    bin(oldest).bits += bits;
    ++bin(oldest).frames;
    return;
  }
  // A frame is stamped at one of its ends: the part of it that was before this bin is the former's.
  double here = bits;
  if (bitrate_bps_ && number > oldest) {
    here = std::min(here, seconds_since_start(time, number) * *bitrate_bps_);
    bin(number - 1).bits += bits - here;
  }
  bin(number).bits += here;
  ++bin(number).frames;
}

void LoadMeter::advance(Timestamp now) {
  const std::int64_t number = number_of(now);
  // The clock was set back: nothing would be new again for as long as that.
  if (!newest_ || number <= *newest_ - open_bins) {
    start(number);
  }
  reach(number);
}

// What has been of the first bin nobody knows: it counts for nothing.
void LoadMeter::start(std::int64_t number) {
  bins_ = {};
  second_ = {};
  complete_ = -open_bins;
  newest_ = number;
}

void LoadMeter::reach(std::int64_t number) {
  // What had come before a long silence counts to the end; after that all is empty.
  const std::int64_t last_that_counts = *newest_ + static_cast<std::int64_t>(bins_.size());
  while (*newest_ < std::min(number, last_that_counts)) {
    bin(*newest_ + 1) = {};
    complete(*newest_ + 1 - open_bins);
    ++*newest_;
  }
  if (*newest_ < number) {
    bins_ = {};
    second_ = {};
    complete_ = bins_a_second;
    newest_ = number;
  }
}

void LoadMeter::complete(std::int64_t number) {
  if (++complete_ <= 0) {
    return;
  }
  second_.bits += bin(number).bits;
  second_.frames += bin(number).frames;
  if (complete_ > bins_a_second) {
    complete_ = bins_a_second;
    second_.bits -= bin(number - bins_a_second).bits;
    second_.frames -= bin(number - bins_a_second).frames;
  }
  if (complete_ == bins_a_second) {
    peak_bits_per_s_ = std::max(peak_bits_per_s_, bits_per_s());
  }
}

double LoadMeter::bits_per_s() const {
  return complete_ > 0 ? second_.bits * bins_a_second / static_cast<double>(complete_) : 0.0;
}

Load LoadMeter::load() const {
  Load load;
  load.bits_per_s = bits_per_s();
  if (complete_ > 0) {
    load.frames_per_s =
        static_cast<double>(second_.frames * bins_a_second) / static_cast<double>(complete_);
  }
  load.peak_bits_per_s = std::max(peak_bits_per_s_, load.bits_per_s);
  if (bitrate_bps_) {
    load.share = load.bits_per_s / *bitrate_bps_;
    load.peak_share = load.peak_bits_per_s / *bitrate_bps_;
  }
  return load;
}

void LoadMeter::clear() {
  newest_.reset();
  second_ = {};
  complete_ = 0;
  peak_bits_per_s_ = 0;
}

}  // namespace roio::cli
