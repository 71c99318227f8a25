#ifndef ROIO_SERIAL_RESULTS_WATCH_HPP
#define ROIO_SERIAL_RESULTS_WATCH_HPP

#include <chrono>

#include "serial/clock.hpp"
#include "serial/down.hpp"

namespace roio::serial {

/// Whether the bridge is overdue with RESULTS for the frames that it has been sent. What there is
/// nothing to tell of is not overdue.
class ResultsWatch {
 public:
  /// Before a frame is sent.
  void look(const DownFrames& down, Time now) {
    if (!down.awaits_taking()) {
      progress_at_ = now;
    }
    if (!down.awaits_outcome()) {
      results_at_ = now;
    }
  }
  /// RESULTS has come.
  void came(DownFrames::Progress progress, Time now) {
    results_at_ = now;
    if (progress == DownFrames::Progress::some) {
      progress_at_ = now;
    }
  }
  /// Frames are being sent again.
  void started_over(Time now) { progress_at_ = now; }

  /// When is_stuck() may become true; Time::max(): it cannot.
  [[nodiscard]] Time deadline(const DownFrames& down) const {
    return down.awaits_taking() ? progress_at_ + taking_time : Time::max();
  }
  /// Frames were not taken: they are to be sent again.
  [[nodiscard]] bool is_stuck(const DownFrames& down, Time now) const {
    return down.awaits_taking() && now >= progress_at_ + taking_time;
  }
  /// RESULTS that all frames wait for was lost, and the bridge has no reason to send another one.
  [[nodiscard]] bool is_lost(const DownFrames& down, Time now) const {
    return down.awaits_outcome() && now >= results_at_ + outcome_time;
  }

 private:
  static constexpr std::chrono::milliseconds taking_time{results_timeout_ms};
  static constexpr std::chrono::milliseconds outcome_time{1000};

  Time progress_at_{0};  // RESULTS last came forward, or there was nothing that it could tell
  Time results_at_{0};   // RESULTS last came, or there was nothing to come
};

}  // namespace roio::serial

#endif
