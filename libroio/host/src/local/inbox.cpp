#include "local/inbox.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "local/readers.hpp"
#include "local/slot_filters.hpp"

namespace roio::local {
namespace {

// At once, so that the program gets its turn.
constexpr std::size_t frames_per_read = 512;

}  // namespace

void Inbox::adopt(ClientMemory memory, const Welcome& welcome) {
  if (log_ && log_->identity == welcome.identity && welcome.fresh == 0) {
    return;  // all is as it was under the last hub
  }
  if (log_ && log_->identity != welcome.identity) {
    finish_log();
  }
  log_.emplace(std::move(memory), welcome);
  if (!filters_.empty()) {
    publish_filters(log_->memory.slot(), filters_);
    log_->reader.begin();
  }
  publish();
}

// The bus begins anew in other memory. What is left in this one nobody adds to any more.
void Inbox::finish_log() {
  while (fetch()) {
  }
  end();
}

void Inbox::end() {
  if (log_) {
    before_.dropped += log_->reader.dropped();
    before_.unheard += log_->memory.slot().unheard.load(std::memory_order_relaxed);
    log_.reset();
  }
}

// A hub that was killed may have carried the last ones and not said so, and no other hub looks
// through this log any more.
std::array<std::uint64_t, lane_count> Inbox::carried_before(const Welcome& welcome) const {
  return log_ && log_->identity != welcome.identity ? last_carried(*log_->memory, client_)
                                                    : std::array<std::uint64_t, lane_count>{};
}

void Inbox::set_filters(std::span<const SocketCanFilter> filters) {
  const bool listened = !filters_.empty();
  while (listened && fetch()) {  // what has been carried up to now, by the old ones
  }
  filters_.assign(filters.begin(), filters.end());
  if (log_) {
    publish_filters(log_->memory.slot(), filters_);
    if (!listened && !filters_.empty()) {
      log_->reader.begin();
    }
  }
}

bool Inbox::fetch() {
  if (!log_ || filters_.empty()) {
    return false;
  }
  std::array<Carried, frames_per_read> frames;
  const auto [count, lost] = log_->reader.read(frames);
  queue_.lose(lost);
  std::size_t i = 0;
  try {
    for (; i < count; ++i) {
      put(frames.at(i));
    }
  } catch (...) {  // no memory, and they are read
    const auto rest = std::span(frames).first(count).subspan(i);
    const auto wanted = static_cast<std::uint64_t>(std::count_if(
        rest.begin(), rest.end(), [this](const Carried& carried) { return wants(carried); }));
    queue_.lose(wanted);
    before_.dropped += wanted;
    throw;
  }
  publish();
  return count > 0;
}

bool Inbox::wants(const Carried& carried) const {
  return carried.sender != client_ && accept(filters_, carried.frame.tagged_id);
}

void Inbox::put(const Carried& carried) {
  if (!wants(carried)) {
    return;
  }
  if (const std::optional<Frame> frame = from_wire(carried.frame)) {
    queue_.put(*frame, Timestamp{std::chrono::nanoseconds(carried.time_ns)});
  }
}

void Inbox::stay_awake() {
  if (log_) {
    log_->reader.stay_awake();
  }
}

std::size_t Inbox::take(std::span<Received> frames) {
  const std::size_t count = queue_.take(frames);
  if (log_) {
    log_->memory.slot().consumed.fetch_add(count, std::memory_order_relaxed);
  }
  publish();
  return count;
}

void Inbox::publish() {
  if (log_) {
    log_->memory.slot().queued.store(queue_.size(), std::memory_order_relaxed);
  }
}

bool Inbox::must_tell() {
  return log_ && queue_.size() <= max_lag &&
         log_->memory.slot().bus_waits.load(std::memory_order_relaxed) != 0 &&
         log_->memory.slot().bus_waits.exchange(0, std::memory_order_seq_cst) != 0;
}

std::size_t Inbox::listeners() const {
  return !log_ ? 0
               : static_cast<std::size_t>(std::count_if(
                     log_->memory->slots.begin(), log_->memory->slots.end(),
                     [this](const Slot& slot) {
                       const std::uint64_t client = slot.client.load(std::memory_order_acquire);
                       return client != 0 && client != client_ && Readers::listens(slot);
                     }));
}

void Inbox::add_to(Statistics& statistics) const {
  queue_.add_to(statistics);
  statistics.dropped += before_.dropped;
  statistics.unheard += before_.unheard;
  if (log_) {
    statistics.dropped += log_->reader.dropped();
    statistics.unheard += log_->memory.slot().unheard.load(std::memory_order_relaxed);
  }
}

std::uint64_t Inbox::dropped() const {
  Statistics statistics;
  add_to(statistics);
  return statistics.dropped;
}

}  // namespace roio::local
