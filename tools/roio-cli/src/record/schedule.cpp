#include "record/schedule.hpp"

#include <algorithm>

#include "record/log_disorder.hpp"

namespace roio::cli {
namespace {

// No pause is longer: a hundred years, which no clock overflows by.
constexpr std::chrono::hours longest_pause{876'000};

}  // namespace

Schedule::Clock::time_point Schedule::due(std::optional<Timestamp> time, Clock::time_point now) {
  if (!pace_.speed || (!time && !last_due_)) {
    return now;
  }
  if (!time) {
    return *last_due_;
  }
  if (!last_due_) {
    last_due_ = now;
  }
  if (!last_time_) {
    set_reference(*time, *last_due_);
  } else if (*time < *last_time_ - log_disorder) {
    ++steps_back_;
    set_reference(*time, *last_due_);
  }
  auto due = reference_due_ + at_pace(*time - reference_time_);
  if (pace_.longest_pause && due - *last_due_ > *pace_.longest_pause) {
    due = *last_due_ + *pace_.longest_pause;
    set_reference(*time, due);
  }
  last_time_ = time;
  last_due_ = std::max(due, *last_due_);
  return *last_due_;
}

void Schedule::set_reference(Timestamp time, Clock::time_point due) {
  reference_time_ = time;
  reference_due_ = due;
}

std::chrono::nanoseconds Schedule::at_pace(std::chrono::nanoseconds in_log) const {
  using Floating = std::chrono::duration<double, std::nano>;
  const Floating scaled = Floating(in_log) / *pace_.speed;
  const Floating longest = longest_pause;
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::clamp(scaled, -longest, longest));
}

}  // namespace roio::cli
