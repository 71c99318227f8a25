#include "serial/session.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace roio {

// All that this file is about.
using namespace serial;  // NOLINT(google-build-using-namespace)

namespace {

using std::chrono::milliseconds;
using Time = SerialSession::Time;

constexpr milliseconds hello_interval{hello_interval_ms};
constexpr milliseconds poll_interval{poll_interval_ms};
constexpr milliseconds silence{bridge_silence_ms};
constexpr milliseconds refused_interval{1000};

// A bridge without a controller looks for it for up to 180 ms, and answers nothing meanwhile.
constexpr milliseconds speed_timeout{400};
constexpr milliseconds trial_time{250};
constexpr milliseconds echo_interval{100};

constexpr unsigned polls_per_counters = 10;
constexpr unsigned nonce_tries = 16;

}  // namespace

SerialSession::SerialSession(SerialSettings settings, Nonces nonces)
    : settings_(std::move(settings)),
      nonces_(std::move(nonces)),
      line_rate_(settings_.line_rate_bps),
      down_(settings_.in_order) {}

// --- the course of a session ---------------------------------------------------------------------

void SerialSession::begin(Time now) {
  line_rate_.begin();
  other_version_.reset();
  refusal_.reset();
  call(now);
}

void SerialSession::end() {
  phase_ = Phase::closed;
  output_.clear();
  line_rate_.start_over();
  down_.begin();
  requests_.end();
}

void SerialSession::lose(Time now) {
  requests_.end();
  call(now);
}

/// HELLO, with a number that no session had.
void SerialSession::call(Time now) {
  phase_ = Phase::calling;
  down_.begin();
  reader_ = RecordReader();
  output_.clear();
  line_rate_.start_over();
  for (unsigned i = 0; i < nonce_tries; ++i) {
    session_ = nonces_();
    if (session_ != no_session && !hello_is_harmful(session_)) {
      break;
    }
  }
  reader_.expect(session_);
  say_hello(now);
}

void SerialSession::say_hello(Time now) {
  hello_at_ = now + hello_interval;
  if (output_.is_clogged()) {
    return;
  }
  output_.put_delimiter();  // whatever the bridge has heard so far is over
  output_.put_hello(session_);
}

/// The bridge cannot do what it is to do, so nothing is sent to a bus where that might disturb.
void SerialSession::refuse(Status status, Time now) {
  lose(now);
  output_.clear();
  refusal_ = status;
  hello_at_ = now + refused_interval;
}

void SerialSession::open_session(const Welcome& welcome, Time now) {
  if (welcome.previous_session != no_session && welcome.previous_session == last_session_) {
    arrivals_.settle_last(welcome.previous_due);
  }
  bridge_.begin(welcome);
  line_rate_.offer(welcome.rates, welcome.info.line_rate_matters);
  arrivals_.begin();
  last_session_ = session_;
  ++counters_.sessions;
  counters_wanted_ = true;
  other_version_.reset();
  refusal_.reset();
  set_up_.begin();
  phase_ = Phase::setting_up;
  poll(now);
  go_on(now);
}

void SerialSession::go_on(Time now) {
  phase_ = Phase::setting_up;
  if (set_up_.takes_line_rate() && ask_speed(now)) {
    return;
  }
  if (std::optional<Request> request = set_up_.next(settings_, bridge_)) {
    ask(std::move(*request), now);
    return;
  }
  phase_ = Phase::ready;
  ask_next(now);
}

Time SerialSession::deadline() const {
  return std::min(course_deadline(), down_.next_end());
}

/// But for frames that wait.
Time SerialSession::course_deadline() const {
  switch (phase_) {
    case Phase::closed:
      return Time::max();
    case Phase::calling:
      return hello_at_;
    case Phase::speeding:
      return std::min(heard_at_ + silence, speed_until_);
    case Phase::trying:
      return std::min({heard_at_ + silence, speed_until_, echo_at_});
    default:
      break;
  }
  const Time results = phase_ == Phase::ready ? results_.deadline(down_) : Time::max();
  return std::min({heard_at_ + silence, poll_at_, requests_.due(), results});
}

void SerialSession::on_time(Time now) {
  down_.drop_expired(now);
  if (now < course_deadline()) {
    return;
  }
  if (phase_ == Phase::calling) {
    say_hello(now);
  } else if (now >= heard_at_ + silence) {
    lose(now);
  } else if (phase_ == Phase::speeding) {
    miss_speed(now);
  } else if (phase_ == Phase::trying && now >= speed_until_) {
    fail_trial(now);
  } else if (phase_ == Phase::trying) {
    send_echoes(now);
  } else {
    serve_timers(now);
  }
}

void SerialSession::serve_timers(Time now) {
  if (now >= poll_at_) {
    poll(now);
  }
  if (now >= requests_.due()) {
    repeat_request(now);
  }
  if (phase_ == Phase::ready) {
    check_progress(now);
    send_frames(now);
  }
}

// --- the line rate -------------------------------------------------------------------------------

/// @return false: there is none better than now. Else nothing else is said until the reply.
bool SerialSession::ask_speed(Time now) {
  const std::optional<std::uint32_t> rate_bps = line_rate_.ask();
  if (!rate_bps) {
    return false;
  }
  phase_ = Phase::speeding;
  speed_until_ = now + speed_timeout;
  speed_request_ = requests_.take_number();
  const std::vector<std::uint8_t> payload = speed_payload(*rate_bps);
  write({Down::speed, speed_request_, payload});
  return true;
}

/// The bridge may have changed its rate or not: only HELLO at the base rate is sure.
void SerialSession::miss_speed(Time now) {
  line_rate_.unanswered();
  lose(now);
}

void SerialSession::begin_trial(Time now) {
  phase_ = Phase::trying;
  line_rate_.try_out();
  speed_until_ = now + trial_time;
  output_.clear();
  output_.put_delimiter();
  send_echoes(now);
}

void SerialSession::send_echoes(Time now) {
  echo_at_ = now + echo_interval;
  for (unsigned i = 0; i < echo_count; ++i) {
    if (line_rate_.is_missing(i)) {
      write_control(Down::echo, echo_payload(i));
    }
  }
}

void SerialSession::fail_trial(Time now) {
  ++counters_.failed_trials;
  line_rate_.give_up();
  lose(now);
}

void SerialSession::step_down_if_needed(Time now) {
  if (!is_settled() || !line_rate_.step_down_if_due()) {
    return;
  }
  ++counters_.step_downs;
  set_up_.begin();
  go_on(now);
}

// --- requests ------------------------------------------------------------------------------------

void SerialSession::set_bus(std::uint32_t bitrate_bps, BridgeMode mode, Time now, Done done) {
  bitrate_bps = bitrate_bps == 0 ? bridge_.info().bitrate_bps : bitrate_bps;
  queue(bus_request(bridge_, bitrate_bps, mode,
                    [this, bitrate_bps, mode, done = std::move(done)](const Reply& reply) {
                      if (reply.is_kept()) {
                        settings_.bitrate_bps = bitrate_bps;
                        settings_.mode = mode;
                      }
                      done(reply);
                    }),
        now);
}

void SerialSession::set_rules(std::vector<Rule> rules, Time now, Done done) {
  settings_.rules = std::move(rules);
  queue({Down::filter, filter_payload(*settings_.rules), std::move(done)}, now);
}

void SerialSession::set_address(Address address, Time now, Done done) {
  queue({Down::address,
         {address.subnet, address.node},
         [this, address, done = std::move(done)](const Reply& reply) {
           if (reply.ok()) {
             settings_.address = address;
             bridge_.set_address(address);
           }
           done(reply);
         }},
        now);
}

void SerialSession::identify(std::uint8_t seconds, Time now, Done done) {
  queue({Down::identify, {seconds}, std::move(done)}, now);
}

void SerialSession::leave(Time now, Done done) {
  requests_.end();
  if (phase_ != Phase::ready && phase_ != Phase::setting_up) {
    end();
    done({Reply::Kind::no_session, Status::ok});
    return;
  }
  phase_ = Phase::ready;
  ask({Down::bye,
       {},
       [this, done = std::move(done)](const Reply& reply) {
         end();
         done(reply);
       }},
      now);
}

void SerialSession::ask_counters(Time now) {
  counters_wanted_ = true;
  if (phase_ == Phase::ready) {
    poll(now);
  }
}

void SerialSession::queue(Request request, Time now) {
  if (!in_session()) {
    request.done({Reply::Kind::no_session, Status::ok});
    return;
  }
  requests_.queue(std::move(request));
  if (phase_ == Phase::ready) {
    ask_next(now);
  }
}

void SerialSession::ask_next(Time now) {
  if (const auto question = requests_.next(now)) {
    write(*question);
  }
}

void SerialSession::repeat_request(Time now) {
  if (const auto question = requests_.repeat(now)) {
    write(*question);
  } else if (phase_ == Phase::setting_up) {
    lose(now);
  } else if (phase_ == Phase::ready) {
    ask_next(now);
  }
}

// --- frames down ---------------------------------------------------------------------------------

std::size_t SerialSession::offer(std::span<const Frame> frames, Time now) {
  if (phase_ != Phase::ready) {
    return 0;
  }
  down_.drop_expired(now);
  const bool has_end = settings_.lifetime < Time::max() - now;
  const std::size_t count = down_.offer(frames, has_end ? now + settings_.lifetime : Time::max());
  send_frames(now);
  return count;
}

void SerialSession::send_frames(Time now) {
  while (phase_ == Phase::ready && !output_.is_clogged()) {
    results_.look(down_, now);
    down_.drop_expired(now);
    const auto next = down_.next();
    if (!next) {
      return;
    }
    output_.put_frame(session_, next->frame, next->sequence, life_until(next->end, now));
  }
}

/// How long it may wait from when the bridge takes it, after what is on the line before it.
std::uint8_t SerialSession::life_until(Time end, Time now) const {
  constexpr unsigned byte_bits = 10;
  if (end == Time::max()) {
    return life_forever;
  }
  const Time on_line = std::chrono::seconds(down_.untaken() * byte_bits) / line_rate_bps();
  const auto left = (end - now - on_line) / std::chrono::microseconds(life_unit_us);
  return left <= 0
             ? std::uint8_t{0}
             : life_of_units(static_cast<std::uint32_t>(std::min<std::int64_t>(left, UINT32_MAX)));
}

void SerialSession::check_progress(Time now) {
  if (results_.is_stuck(down_, now)) {
    down_.go_back();
    results_.started_over(now);
  }
  if (bridge_.controller_works() && results_.is_lost(down_, now)) {
    lose(now);
  }
}

// --- outgoing records ----------------------------------------------------------------------------

void SerialSession::write_control(Down operation, std::span<const std::uint8_t> payload) {
  output_.put_control(session_, operation, down_.sequence(), payload);
}

void SerialSession::write(const Requests::Question& question) {
  output_.put_numbered(session_, question.operation, down_.sequence(), question.number,
                       question.payload);
}

void SerialSession::poll(Time now) {
  poll_at_ = now + poll_interval;
  if (output_.is_clogged()) {
    return;
  }
  counters_wanted_ = counters_wanted_ || polls_ % polls_per_counters == 0;
  ++polls_;
  write_control(Down::poll, std::array<std::uint8_t, 1>{std::uint8_t{counters_wanted_}});
}

BridgeInfo SerialSession::info() const {
  BridgeInfo info = bridge_.info();
  info.line_rate_bps = line_rate_bps();
  info.real_bitrate_bps = real_bitrate_bps(info);
  if (!in_session()) {
    info.state = BridgeState::absent;
  }
  return info;
}

SerialSession::Counters SerialSession::counters() const {
  Counters counters = counters_;
  counters.retries = requests_.retries();
  return counters;
}

}  // namespace roio
