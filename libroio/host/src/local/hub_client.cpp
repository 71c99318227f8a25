#include "local/hub_client.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <system_error>
#include <utility>

namespace roio::local {
namespace {

constexpr std::chrono::seconds greeting_time{5};
// Consuming fewer than this in one patience (some 10,000 frames a second, less than a saturated
// 1 Mbit/s bus brings) does not count as reading: the others should not crawl along with it.
constexpr std::uint64_t reading = 1024;

}  // namespace

bool HubClient::greeting_overdue(TimePoint now) const {
  return !greeted() && now - since_ > greeting_time;
}

void HubClient::welcome(std::shared_ptr<Station> station, bool rejoining, const Welcome& welcome,
                        std::uint64_t listeners) {
  auto page = std::make_unique<CounterPage>();
  page->counters().listeners.store(listeners, std::memory_order_relaxed);
  Buffer bytes;
  append_record(bytes, welcome);
  // The socket is fresh, so there is room; a client that is gone already shows at the next read.
  if (!send_with_fd(stream_.fd(), bytes, page->fd())) {
    throw std::system_error(std::make_error_code(std::errc::broken_pipe), "welcome");
  }
  page_ = std::move(page);
  station_ = std::move(station);
  replay_due_ = rejoining;
}

bool HubClient::consumed(std::uint64_t count, TimePoint now) {
  if (count < consumed_ || count > delivered_) {
    return false;
  }
  consumed_ = count;
  if (consumed_ - checkpoint_ >= reading) {
    checkpoint_ = consumed_;
    checkpoint_time_ = now;
  }
  return true;
}

void HubClient::note_listeners(std::uint64_t count) {
  if (page_) {
    page_->counters().listeners.store(count, std::memory_order_relaxed);
  }
}

void HubClient::note_unheard() {
  page_->counters().unheard.fetch_add(1, std::memory_order_relaxed);
}

void HubClient::forget_unheard() {
  if (page_) {
    page_->counters().unheard.store(0, std::memory_order_relaxed);
  }
}

bool HubClient::wants(std::uint32_t tagged) const {
  return std::any_of(filters_.begin(), filters_.end(),
                     [=](const SocketCanFilter& filter) { return accepts(filter, tagged); });
}

void HubClient::drop(std::uint64_t count) {
  due_ += count;
  page_->counters().dropped.fetch_add(count, std::memory_order_relaxed);
}

void HubClient::deliver(Deliver deliver, std::uint64_t bus_number, TimePoint now) {
  const std::uint64_t lag = delivered_ - consumed_;
  if (lag >= queue_limit) {
    drop(1);
    return;
  }
  if (lag == max_lag) {
    checkpoint_time_ = now;  // starts to lag: its patience starts here
  }
  ++delivered_;
  deliver.index = ++due_;
  append_record(stream_.out(), deliver);
  if (unflushed_.empty()) {
    flush_checkpoint_ = flushed_;
    flush_time_ = now;
  }
  unflushed_.push_back(Unflushed{stream_.appended(), bus_number});
}

void HubClient::report_done(std::size_t lane, std::uint64_t sequence) {
  done_.at(lane) = sequence;
  done_changed_ = true;
}

void HubClient::append_done() {
  // One at a time is under way: a client that does not read must not pile them up.
  if (done_changed_ && stream_.sent() >= done_end_) {
    append_record(stream_.out(), Done{done_});
    done_changed_ = false;
    done_end_ = stream_.appended();
  }
}

bool HubClient::flush(TimePoint now) {
  if (!stream_.flush()) {
    return false;
  }
  while (!unflushed_.empty() && unflushed_.front().end <= stream_.sent()) {
    unflushed_.pop_front();
    ++flushed_;
  }
  if (flushed_ - flush_checkpoint_ >= reading) {
    flush_checkpoint_ = flushed_;
    flush_time_ = now;
  }
  return true;
}

bool HubClient::holds_bus(TimePoint now) const {
  return delivered_ - consumed_ > max_lag && now - checkpoint_time_ < patience;
}

std::optional<std::uint64_t> HubClient::first_unflushed() const {
  return unflushed_.empty() ? std::nullopt : std::optional(unflushed_.front().bus_number);
}

bool HubClient::holds_done(TimePoint now, bool paced) const {
  return !unflushed_.empty() && !paced && now - flush_time_ < patience;
}

void HubClient::note_risk(std::uint64_t done_number) {
  if (!page_) {
    return;
  }
  const auto end = std::upper_bound(
      unflushed_.begin(), unflushed_.end(), done_number,
      [](std::uint64_t number, const Unflushed& frame) { return number < frame.bus_number; });
  page_->counters().at_risk.store(static_cast<std::uint64_t>(end - unflushed_.begin()),
                                  std::memory_order_relaxed);
}

}  // namespace roio::local
