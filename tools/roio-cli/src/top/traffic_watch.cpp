#include "top/traffic_watch.hpp"

#include <span>

#include "form/labels.hpp"

namespace roio::cli {
namespace {

constexpr std::size_t batch_size = 256;

constexpr HubWatch::Clock::duration look_around_every = std::chrono::milliseconds(200);

// So many batches at a time, so that keys are heard and the screen is drawn in a flood, too.
constexpr int max_batches = 64;

// Below this nothing is lost by letting some more gather.
constexpr std::size_t many = batch_size / 4;

}  // namespace

TrafficWatch::TrafficWatch(Bus& bus, const std::string& url,
                           std::optional<std::uint32_t> bitrate_bps, const Labels& labels)
    : bus_(bus),
      is_local_(bus.name().starts_with("local:")),
      bitrate_(bus, url, bitrate_bps),
      table_(labels),
      batch_(batch_size) {
  table_.meter().set_bitrate(bitrate_.bps());
}

TrafficWatch::Taken TrafficWatch::take() {
  look_at_hub();
  std::size_t taken = 0;
  for (int i = 0; i < max_batches; ++i) {
    const Transfer transfer = bus_.receive(batch_, no_wait);
    for (const Received& received : std::span(batch_).first(transfer.count)) {
      table_.add(received);
    }
    taken += transfer.count;
    if (transfer.result == Result::closed) {
      return Taken::closed;
    }
    if (transfer.count < batch_size) {
      return taken == 0 ? Taken::nothing : taken < many ? Taken::some : Taken::many;
    }
  }
  return Taken::many;
}

// Asks the kernel, so not for every batch.
void TrafficWatch::look_at_hub() {
  const HubWatch::Clock::time_point now = HubWatch::Clock::now();
  if (is_local_ && now >= next_look_) {
    hub_watch_.look(bus_.state(), now);
    next_look_ = now + look_around_every;
  }
}

Statistics TrafficWatch::statistics() const {
  Statistics statistics = bus_.statistics();
  if (is_local_) {
    statistics.outages = hub_watch_.outages();
  }
  return statistics;
}

Snapshot TrafficWatch::snapshot() {
  Snapshot snapshot;
  snapshot.time = std::chrono::system_clock::now();
  table_.meter().set_bitrate(bitrate_.bps());
  table_.tick(snapshot.time);
  const Statistics now = statistics();
  snapshot.bus = bus_.name();
  snapshot.state = bus_.state();
  snapshot.bitrate_bps = table_.meter().bitrate();
  snapshot.load = table_.meter().load();
  snapshot.frames = table_.frames();
  snapshot.lost = now.dropped - cleared_.dropped;
  snapshot.errors = now.error_frames - cleared_.error_frames;
  snapshot.bus_offs = now.bus_offs - cleared_.bus_offs;
  snapshot.outages = now.outages - cleared_.outages;
  snapshot.overruns = now.overruns - cleared_.overruns;
  snapshot.fd_frames = now.fd_frames - cleared_.fd_frames;
  snapshot.rowless = table_.rowless();
  snapshot.rows = table_.rows();
  return snapshot;
}

void TrafficWatch::clear() {
  table_.clear();
  cleared_ = statistics();
}

}  // namespace roio::cli
