#include <algorithm>
#include <cmath>
#include <roio/header.hpp>
#include <roio/sim/can_bus.hpp>
#include <utility>

namespace roio::sim {
namespace {

constexpr std::int64_t default_sample_percent = 80;
constexpr std::int64_t default_jumps_per_bit = 8;
// Nodes whose bit times differ by less than one in this many keep step, as synchronisation makes
// them.
constexpr std::int64_t in_step = 1000;

}  // namespace

SimTime BusStatistics::Latency::mean() const {
  return frames == 0 ? SimTime(0) : sum / static_cast<std::int64_t>(frames);
}

NodeTiming timing_of(std::uint32_t bitrate_bps) {
  const SimTime bit = cycles(1, bitrate_bps);
  return {bit, bit * default_sample_percent / 100, bit / default_jumps_per_bit};
}

CanBus::~CanBus() {
  for (const auto& domain : domains_) {
    for (const Member& member : domain->members) {
      member.controller->set_monitor(nullptr);
    }
  }
}

// --- members
// ------------------------------------------------------------------------------------------

void CanBus::join(Controller& controller, const NodeTiming& timing) {
  leave(controller);
  controller.set_monitor(this);
  for (const auto& domain : domains_) {
    if (std::chrono::abs(domain->timing.bit - timing.bit) * in_step <= timing.bit) {
      domain->members.push_back({&controller});
      return;
    }
  }
  auto domain = std::make_unique<Domain>();
  domain->timing = timing;
  domain->members.push_back({&controller});
  domain->bit_start = now_ - timing.bit;
  domains_.push_back(std::move(domain));
}

void CanBus::leave(Controller& controller) {
  controller.set_monitor(nullptr);
  for (const auto& domain : domains_) {
    std::erase_if(domain->members, [&](const Member& m) { return m.controller == &controller; });
  }
  std::erase_if(domains_, [](const auto& domain) { return domain->members.empty(); });
}

CanBus::Member* CanBus::find(const Controller& controller) {
  for (const auto& domain : domains_) {
    for (Member& member : domain->members) {
      if (member.controller == &controller) {
        return &member;
      }
    }
  }
  return nullptr;
}

// --- time
// ---------------------------------------------------------------------------------------------

bool CanBus::later(const Action& a, const Action& b) {
  return a.time != b.time ? a.time > b.time : a.order > b.order;
}

void CanBus::at(SimTime time, std::function<void()> action) {
  actions_.push_back({std::max(time, now_), actions_so_far_++, std::move(action)});
  std::push_heap(actions_.begin(), actions_.end(), later);
}

void CanBus::run_actions() {
  while (!actions_.empty() && actions_.front().time <= now_) {
    std::pop_heap(actions_.begin(), actions_.end(), later);
    const std::function<void()> action = std::move(actions_.back().action);
    actions_.pop_back();
    action();
  }
}

CanBus::Domain* CanBus::next_domain() const {
  Domain* first = nullptr;
  for (const auto& domain : domains_) {
    if (first == nullptr || domain->next() < first->next()) {
      first = domain.get();
    }
  }
  return first;
}

bool CanBus::quiet() const {
  return !held_ && std::all_of(domains_.begin(), domains_.end(), [](const auto& domain) {
    return std::all_of(domain->members.begin(), domain->members.end(),
                       [](const Member& member) { return member.controller->quiet(); });
  });
}

// Nobody keeps time on an idle bus: whoever starts next, starts a bit right then.
void CanBus::skip_to(SimTime time) {
  now_ = time;
  for (const auto& domain : domains_) {
    domain->bit_start = time - domain->timing.bit;
    domain->sampling = false;
    domain->driven = recessive;
  }
}

void CanBus::run_until(SimTime time) {
  for (;;) {
    run_actions();
    const SimTime limit = actions_.empty() ? time : std::min(time, actions_.front().time);
    Domain* const domain = next_domain();
    if (domain != nullptr && !domain->sampling && quiet()) {
      skip_to(std::max(now_, limit));
    } else if (domain != nullptr && domain->next() <= limit) {
      now_ = std::max(now_, domain->next());
      if (domain->sampling) {
        sample(*domain);
      } else {
        begin_bit(*domain);
      }
      continue;
    } else {
      now_ = std::max(now_, limit);
    }
    if (actions_.empty() || actions_.front().time > now_) {
      return;
    }
  }
}

// --- one bit
// ------------------------------------------------------------------------------------------

std::uint8_t CanBus::wire() const {
  std::uint8_t level = held_ ? dominant : recessive;
  for (const auto& domain : domains_) {
    level &= domain->driven;
  }
  return level;
}

void CanBus::begin_bit(Domain& domain) {
  const std::uint8_t before = wire();
  domain.bit_start += domain.timing.bit;
  domain.sampling = true;
  std::uint8_t driven = recessive;
  for (const Member& member : domain.members) {
    const std::uint8_t level = member.controller->begin_bit();
    driven &= member.cut ? recessive : level;
  }
  domain.driven = driven;
  if (domains_.size() > 1 && before == recessive && wire() == dominant) {
    falling_edge(domain);
  }
}

// Nodes of other rates synchronise: hard when none of them is in a frame, else by at most the jump
// width (CAN 2.0B, 9.1). A node that drives the wire itself follows nobody.
void CanBus::falling_edge(const Domain& source) {
  for (const auto& domain : domains_) {
    if (domain.get() == &source || domain->driven == dominant) {
      continue;
    }
    const bool busy = std::any_of(domain->members.begin(), domain->members.end(),
                                  [](const Member& m) { return m.controller->busy(); });
    const NodeTiming& timing = domain->timing;
    if (!busy) {
      domain->bit_start = now_;
      domain->sampling = true;
    } else if (domain->sampling) {
      domain->bit_start += std::min(now_ - domain->bit_start, timing.jump_width);
    } else {
      domain->bit_start -= std::min(domain->bit_start + timing.bit - now_, timing.jump_width);
    }
  }
}

void CanBus::sample(Domain& domain) {
  domain.sampling = false;
  const std::uint8_t level = wire();
  if (flip_next_ || fault_probability_ > 0) {
    sample_with_fault(domain, level);
  } else {
    for (const Member& member : domain.members) {
      member.controller->sample(level);
    }
  }
  const bool busy = std::any_of(domain.members.begin(), domain.members.end(),
                                [](const Member& m) { return m.controller->busy(); });
  if (busy && &domain == domains_.front().get()) {
    statistics_.busy += domain.timing.bit;
  }
}

// --- faults
// -------------------------------------------------------------------------------------------

void CanBus::set_bit_errors(double probability, std::uint32_t seed) {
  fault_probability_ = probability;
  generator_.seed(seed);
  if (probability > 0) {
    draw_next_fault();
  }
}

// How many samples pass unharmed: geometric, so that no number is drawn for each bit.
void CanBus::draw_next_fault() {
  samples_to_fault_ =
      fault_probability_ >= 1
          ? 0
          : std::geometric_distribution<std::uint64_t>(fault_probability_)(generator_);
}

void CanBus::flip_next_bit(Controller* victim) {
  flip_next_ = true;
  flip_victim_ = victim;
}

void CanBus::cut_transmitter(Controller& controller, bool cut) {
  if (Member* const member = find(controller)) {
    member->cut = cut;
  }
}

void CanBus::sample_with_fault(Domain& domain, std::uint8_t level) {
  bool flip = std::exchange(flip_next_, false);
  Controller* victim = std::exchange(flip_victim_, nullptr);
  if (!flip && fault_probability_ > 0) {
    flip = samples_to_fault_ == 0;
    if (flip) {
      const auto choice = static_cast<std::size_t>(generator_()) % (2 * domain.members.size());
      victim = choice < domain.members.size() ? domain.members[choice].controller : nullptr;
      draw_next_fault();
    } else {
      --samples_to_fault_;
    }
  }
  if (flip) {
    ++statistics_.flipped_bits;
  }
  for (const Member& member : domain.members) {
    const bool hit = flip && (victim == nullptr || victim == member.controller);
    member.controller->sample(hit ? level ^ 1U : level);
  }
}

// --- what happens
// ---------------------------------------------------------------------------------------

void CanBus::on_frame(std::function<void(const Frame&, const Controller&)> observer) {
  observers_.push_back(std::move(observer));
}

void CanBus::on_transmitted(const Controller& sender) {
  const Submission& sent = sender.submission();
  ++statistics_.frames;
  const bool urgent =
      is_extended(sent.frame.kind) && unpack_id(sent.frame.id).priority == Priority::urgent;
  BusStatistics::Latency& latency = urgent ? statistics_.urgent : statistics_.normal;
  const SimTime taken = now_ - sent.since;
  ++latency.frames;
  latency.sum += taken;
  latency.max = std::max(latency.max, taken);
  for (const auto& observer : observers_) {
    observer(sent.frame, sender);
  }
}

void CanBus::on_transmit_error(const Controller& /*sender*/) {
  ++statistics_.transmit_errors;
}

void CanBus::on_arbitration_lost(const Controller& /*sender*/) {
  ++statistics_.arbitrations_lost;
}

}  // namespace roio::sim
