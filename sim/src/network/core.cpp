#include "network/core.hpp"

#include <algorithm>
#include <roio/bit_timing.hpp>
#include <roio/parts/thread.hpp>
#include <stdexcept>
#include <string>
#include <utility>

namespace roio::sim {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

// At most so much simulated time passes before calls are looked at again.
constexpr SimTime slice = milliseconds(1);
// How much of it lets the thread sleep: a frame that is under way should not arrive late, and an
// idle bus should cost little.
constexpr SimTime busy_nap = microseconds(100);
constexpr SimTime idle_nap = milliseconds(1);

BitTiming checked_timing(const NetworkOptions& options) {
  const BitTiming timing = compute_bit_timing(options.osc_hz, options.bitrate_bps);
  if (!is_valid(timing)) {
    throw std::invalid_argument(
        options.name + ": no bit timing gives " + std::to_string(options.bitrate_bps) +
        " bit/s with an oscillator of " + std::to_string(options.osc_hz) + " Hz");
  }
  return timing;
}

}  // namespace

// --- pace ----------------------------------------------------------------------------------------

SimTime Pace::due() const {
  const std::chrono::duration<double, std::pico> real = Clock::now() - start_;
  return SimTime(static_cast<SimTime::rep>(real.count() * speed_));
}

Pace::Clock::time_point Pace::real(SimTime time) const {
  const std::chrono::duration<double, std::pico> real(static_cast<double>(time.count()) / speed_);
  return start_ + std::chrono::ceil<Clock::duration>(real);
}

// --- from any thread -----------------------------------------------------------------------------

NetworkCore::NetworkCore(const NetworkOptions& options)
    : options_(options),
      timing_(checked_timing(options)),
      epoch_(std::chrono::system_clock::now()) {
  if (!(options.speed >= 0)) {
    throw std::invalid_argument(options.name + ": a speed of " + std::to_string(options.speed) +
                                ", expected 0 or more");
  }
  if (options.speed > 0) {
    pace_.emplace(options.speed);
  }
  if (options.witness) {
    witness_.emplace(bus_, options.bitrate_bps);
  }
  schedule_poll();
  thread_ = start_thread([this] { run(); });
}

void NetworkCore::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) {
    thread_.join();
  }
}

bool NetworkCore::call(const std::function<void()>& action) {
  std::packaged_task<void()> task(action);
  std::future<void> done = task.get_future();
  {
    const std::lock_guard lock(mutex_);
    if (ended_) {
      return false;
    }
    calls_.push_back(&task);
  }
  changed_.notify_all();
  done.get();
  return true;
}

void NetworkCore::wake() {
  {
    const std::lock_guard lock(mutex_);
    woken_ = true;
  }
  changed_.notify_all();
}

// --- the simulation's thread ---------------------------------------------------------------------

bool NetworkCore::add(const std::shared_ptr<Exchange>& exchange) {
  auto station = std::make_unique<Station>(bus_, options_, timing_, epoch_, exchange);
  if (station->begin() != Status::ok) {
    return false;
  }
  stations_.push_back(std::move(station));
  return true;
}

// Simulated time goes on in leave(), so that all stations have to be there meanwhile.
void NetworkCore::remove_leaving() {
  std::vector<std::shared_ptr<Exchange>> left;
  for (const auto& station : stations_) {
    if (station->wants_to_leave()) {
      left.push_back(station->leave());
    }
  }
  std::erase_if(stations_, [](const auto& station) { return station->has_left(); });
  for (const auto& exchange : left) {
    exchange->left();
  }
}

void NetworkCore::run() {
  // What is asked for is done at the time that it is, not when the thread last looked.
  do {
    wait();
    advance();
    remove_leaving();
  } while (run_calls());
  for (const auto& station : stations_) {
    station->end();
  }
  stations_.clear();
}

/// @return false: it is over, and nobody will ask for anything any more.
bool NetworkCore::run_calls() {
  std::unique_lock lock(mutex_);
  while (!calls_.empty()) {
    const auto calls = std::exchange(calls_, {});
    lock.unlock();
    for (std::packaged_task<void()>* const task : calls) {
      (*task)();
    }
    lock.lock();
  }
  ended_ = stopping_;
  const bool woken = std::exchange(woken_, false);
  lock.unlock();
  if (woken) {
    poll_stations();  // so that a frame is not late by a nap
  }
  return !ended_;
}

void NetworkCore::advance() {
  const SimTime end = bus_.now() + slice;
  bus_.run_until(pace_ ? std::min(pace_->due(), end) : end);
}

/// As long as simulated time is ahead of the other one.
void NetworkCore::wait() {
  if (!pace_ || pace_->due() > bus_.now() + slice) {
    return;
  }
  const auto until = pace_->real(bus_.now() + (is_busy() ? busy_nap : idle_nap));
  busy_seen_ = bus_.statistics().busy;
  std::unique_lock lock(mutex_);
  changed_.wait_until(lock, until, [this] { return woken_ || stopping_ || !calls_.empty(); });
}

bool NetworkCore::is_busy() const {
  return bus_.statistics().busy != busy_seen_ ||
         std::any_of(stations_.begin(), stations_.end(),
                     [](const auto& station) { return station->exchange().has_work(); });
}

// As an action of the wire's, so that processors work also while another one's chip is begun.
void NetworkCore::schedule_poll() {
  bus_.after(poll_interval, [this] {
    schedule_poll();
    poll_stations();
  });
}

void NetworkCore::poll_stations() {
  for (const auto& station : stations_) {
    station->poll();
  }
}

}  // namespace roio::sim
