#include <algorithm>
#include <cmath>
#include <roio/header.hpp>
#include <roio/sim/can_bus.hpp>
#include <stdexcept>
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

double BusStatistics::load() const {
  return time <= SimTime(0) ? 0
                            : static_cast<double>(busy.count()) / static_cast<double>(time.count());
}

NodeTiming timing_of(std::uint32_t bitrate_bps) {
  const SimTime bit = cycles(1, bitrate_bps);
  return {bit, bit * default_sample_percent / 100, bit / default_jumps_per_bit};
}

CanBus::~CanBus() {
  for (const auto& domain : domains_) {
    for (Controller* const member : domain->members) {
      member->set_monitor(nullptr);
    }
  }
}

// --- members -------------------------------------------------------------------------------------

void CanBus::join(Controller& controller, const NodeTiming& timing) {
  leave(controller);
  if (within_bit_) {
    joining_.push_back({&controller, timing});
  } else {
    admit(controller, timing);
  }
}

void CanBus::admit(Controller& controller, const NodeTiming& timing) {
  controller.set_monitor(this);
  for (const auto& domain : domains_) {
    if (std::chrono::abs(domain->timing.bit - timing.bit) * in_step <= timing.bit) {
      domain->members.push_back(&controller);
      return;
    }
  }
  auto domain = std::make_unique<Domain>();
  domain->timing = timing;
  domain->members.push_back(&controller);
  domain->bit_start = now_ - timing.bit;
  domains_.push_back(std::move(domain));
}

void CanBus::leave(Controller& controller) {
  controller.set_monitor(nullptr);
  std::erase_if(joining_, [&](const Joining& j) { return j.controller == &controller; });
  for (const auto& domain : domains_) {
    std::replace(domain->members.begin(), domain->members.end(), &controller,
                 static_cast<Controller*>(nullptr));
  }
  left_within_bit_ = true;
  if (!within_bit_) {
    tidy();
  }
}

// A controller that leaves or joins within a bit must not move the others about under its feet.
void CanBus::tidy() {
  if (left_within_bit_) {
    left_within_bit_ = false;
    for (const auto& domain : domains_) {
      std::erase(domain->members, nullptr);
    }
    std::erase_if(domains_, [](const auto& domain) { return domain->members.empty(); });
  }
  for (const Joining& joining : std::exchange(joining_, {})) {
    admit(*joining.controller, joining.timing);
  }
}

// --- time ----------------------------------------------------------------------------------------

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
                       [](const Controller* member) { return member->quiet(); });
  });
}

bool CanBus::is_idle(const Domain* next) const {
  return next == nullptr || (!next->sampling && quiet());
}

// Nobody keeps time on an idle bus: whoever starts next, starts a bit right then, but for the bit
// that is not over yet.
void CanBus::skip_to(SimTime time) {
  now_ = time;
  for (const auto& domain : domains_) {
    if (domain->next() < time) {
      domain->bit_start = std::max(domain->bit_start, time - domain->timing.bit);
      domain->sampling = false;
      domain->driven = recessive;
    }
  }
}

void CanBus::run_until(SimTime time) {
  if (within_bit_) {
    throw std::logic_error("the bus runs already: a controller's client must not run it");
  }
  const SimTime outer_end = std::exchange(run_end_, std::max(time, now_));
  try {
    run_to(time);
  } catch (...) {
    run_end_ = outer_end;
    throw;
  }
  run_end_ = outer_end;
}

void CanBus::run_to(SimTime time) {
  for (;;) {
    run_due();
    const SimTime limit = std::max(now_, std::min(time, next_call().value_or(time)));
    Domain* const domain = next_domain();
    const bool idle = is_idle(domain);
    if (!idle && domain->next() < limit) {
      now_ = std::max(now_, domain->next());
      step(*domain);
      continue;
    }
    if (idle) {
      skip_to(limit);
    }
    now_ = limit;
    if (next_call().value_or(SimTime::max()) > now_) {
      return;
    }
  }
}

void CanBus::run_due() {
  for (;;) {
    run_actions();
    const auto due = std::find_if(companions_.begin(), companions_.end(),
                                  [this](const auto* c) { return c->next && *c->next <= now_; });
    if (due == companions_.end()) {
      return;
    }
    (*due)->step();
  }
}

std::optional<SimTime> CanBus::next_call() const {
  std::optional<SimTime> first;
  if (!actions_.empty()) {
    first = actions_.front().time;
  }
  for (const Companion* const companion : companions_) {
    if (companion->next && (!first || *companion->next < *first)) {
      first = companion->next;
    }
  }
  return first;
}

SimTime CanBus::quiet_until(const Companion& companion) const {
  SimTime end = run_end_;
  if (!actions_.empty()) {
    end = std::min(end, actions_.front().time);
  }
  for (const Companion* const other : companions_) {
    if (other != &companion && other->next) {
      end = std::min(end, *other->next + other->reach);
    }
  }
  if (end <= now_) {
    return now_;
  }
  const Domain* const domain = next_domain();
  return is_idle(domain) ? end : std::max(now_, std::min(end, domain->next()));
}

// --- one bit -------------------------------------------------------------------------------------

void CanBus::step(Domain& domain) {
  within_bit_ = true;
  if (domain.sampling) {
    sample(domain);
  } else {
    begin_bit(domain);
  }
  within_bit_ = false;
  if (left_within_bit_ || !joining_.empty()) {
    tidy();
  }
}

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
  for (Controller* const member : domain.members) {
    if (member != nullptr) {
      driven &= member->begin_bit();
    }
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
    const bool begins_now = !domain->sampling && domain->next() == now_;
    if (domain.get() == &source || domain->driven == dominant || begins_now) {
      continue;
    }
    const bool busy = std::any_of(domain->members.begin(), domain->members.end(),
                                  [](const Controller* m) { return m != nullptr && m->busy(); });
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
  count_busy(domain);
  if (flip_next_ || fault_probability_ > 0) {
    return sample_with_fault(domain, level);
  }
  for (Controller* const member : domain.members) {
    if (member != nullptr) {
      member->sample(level);
    }
  }
}

// Time in which nodes of several rates are busy counts once. Listeners are busy with others' frames
// or with what they take for one.
void CanBus::count_busy(const Domain& domain) {
  const bool busy = std::any_of(
      domain.members.begin(), domain.members.end(),
      [](const Controller* m) { return m->busy() && m->mode() == Controller::Mode::normal; });
  const SimTime end = domain.bit_start + domain.timing.bit;
  if (busy && end > busy_until_) {
    statistics_.busy += end - std::max(domain.bit_start, busy_until_);
    busy_until_ = end;
  }
}

// --- faults --------------------------------------------------------------------------------------

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

// The victim of the fault that is due now in this domain: none, one controller, or all (null).
std::optional<Controller*> CanBus::draw_victim(const Domain& domain) {
  const auto& members = domain.members;
  if (flip_next_ && (flip_victim_ == nullptr ||
                     std::find(members.begin(), members.end(), flip_victim_) != members.end())) {
    flip_next_ = false;
    return std::exchange(flip_victim_, nullptr);
  }
  if (fault_probability_ <= 0 || samples_to_fault_-- > 0) {
    return std::nullopt;
  }
  draw_next_fault();
  const auto choice = static_cast<std::size_t>(generator_()) % (2 * members.size());
  return choice < members.size() ? members[choice] : nullptr;
}

void CanBus::sample_with_fault(Domain& domain, std::uint8_t level) {
  const std::optional<Controller*> victim = draw_victim(domain);
  statistics_.flipped_bits += victim ? 1U : 0U;
  for (Controller* const member : domain.members) {
    const bool hit = victim && (*victim == nullptr || *victim == member);
    if (member != nullptr) {
      member->sample(hit ? level ^ 1U : level);
    }
  }
}

// --- what happens --------------------------------------------------------------------------------

BusStatistics CanBus::statistics() const {
  BusStatistics result = statistics_;
  result.time = now_;
  return result;
}

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
