#include "serial/line_rate.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "serial/payloads.hpp"

namespace roio::serial {
namespace {

constexpr unsigned max_unanswered = 2;
constexpr int tolerable_in_trial = 1;    // damaged records: the change of rate may make one
constexpr int tolerable_of_history = 7;  // of 64

}  // namespace

void LineRate::begin() {
  limit_ = rate_count - 1U;
  unanswered_ = 0;
}

void LineRate::start_over() {
  rate_ = 0;
  has_heard_ = true;
}

void LineRate::offer(std::uint8_t rates, bool matters) {
  offered_ = matters ? rates : std::uint8_t{1};
  history_ = 0;
}

unsigned LineRate::best() const {
  unsigned best = 0;
  for (unsigned i = 1; i <= limit_; ++i) {
    const bool offered = ((offered_ >> i) & 1U) != 0;
    if (offered && bps_of(i) <= highest_bps_) {
      best = i;
    }
  }
  return best;
}

std::optional<std::uint32_t> LineRate::ask() {
  asked_ = best();
  return asked_ == rate_ ? std::nullopt : std::optional(bps_of(asked_));
}

void LineRate::unanswered() {
  if (++unanswered_ >= max_unanswered) {
    unanswered_ = 0;
    limit_below(asked_);
  }
}

void LineRate::refused() {
  limit_below(asked_);
}

void LineRate::try_out() {
  unanswered_ = 0;
  rate_ = asked_;
  history_ = 0;
  has_heard_ = false;
  missing_ = (1U << echo_count) - 1U;
}

LineRate::Trial LineRate::take(std::span<const std::uint8_t> payload) {
  const unsigned number = payload.empty() ? echo_count : payload[0];
  if (number >= echo_count || !std::ranges::equal(payload, echo_payload(number))) {
    return Trial::nonsense;
  }
  missing_ &= ~(1U << number);
  if (missing_ != 0) {
    return Trial::going;
  }
  return damaged_lately() > tolerable_in_trial ? Trial::failed : Trial::passed;
}

void LineRate::give_up() {
  limit_below(rate_);
}

void LineRate::note_intact() {
  history_ <<= 1U;
  has_heard_ = true;
}

bool LineRate::note_damaged() {
  history_ = (history_ << 1U) | 1U;
  return std::exchange(has_heard_, true);
}

int LineRate::damaged_lately() const {
  return std::popcount(history_);
}

bool LineRate::step_down_if_due() {
  if (rate_ == 0 || damaged_lately() <= tolerable_of_history) {
    return false;
  }
  history_ = 0;
  limit_below(rate_);
  return true;
}

}  // namespace roio::serial
