#include "serial/session.hpp"

#include <algorithm>
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
constexpr milliseconds results_timeout{results_timeout_ms};
// RESULTS that all frames wait for was lost, and the bridge has no reason to send another one.
constexpr milliseconds results_lost{1000};
constexpr milliseconds refused_interval{1000};

// A bridge without a controller looks for it for up to 180 ms, and answers nothing meanwhile.
constexpr milliseconds speed_timeout{400};
constexpr milliseconds trial_time{250};
constexpr milliseconds echo_interval{100};
constexpr milliseconds bye_interval{50};
constexpr milliseconds bus_interval{300};  // the controller is started anew, which takes its time
constexpr milliseconds request_interval{100};
constexpr unsigned max_tries = 4;

constexpr unsigned polls_per_counters = 10;
constexpr unsigned max_questions = 4;   // for the crystal, in a session
constexpr unsigned max_impossible = 2;  // STATUS in a row
// As much may wait for the port; then it does not take any, and nothing is added.
constexpr std::size_t clogged = 1024;

// Optiboot writes to the flash when it sees this byte where it expects a command: an Uno that has
// just been reset may find the middle of a HELLO there.
constexpr std::uint8_t boot_loader_write = 0x64;
constexpr unsigned nonce_tries = 16;

Time interval_of(Down operation) {
  switch (operation) {
    case Down::bye:
      return bye_interval;
    case Down::bus:
      return bus_interval;
    default:
      return request_interval;
  }
}

struct Record {
  std::array<std::uint8_t, max_record> bytes{};
  std::uint8_t length = 0;

  void put(std::uint8_t offset, std::uint8_t byte) { bytes.at(offset) = byte; }
  [[nodiscard]] std::span<const std::uint8_t> span() const {
    return std::span(bytes).first(length);
  }
};

Record hello_of(std::uint32_t session) {
  Record record;
  RecordWriter<Record> writer(record, no_session);
  writer.put(static_cast<std::uint8_t>(Down::hello));
  writer.put(0);
  writer.put(protocol_version);
  writer.put32(session);
  record.length = writer.finish();
  return record;
}

bool is_kept(const SerialSession::Reply& reply) {
  return reply.kind == SerialSession::Reply::Kind::answered &&
         reply.status != Status::bad_argument && reply.status != Status::bad_timing;
}

}  // namespace

SerialSession::SerialSession(SerialSettings settings, Nonces nonces)
    : settings_(std::move(settings)),
      nonces_(std::move(nonces)),
      line_rate_(settings_.line_rate_bps) {}

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
  answer_all(Reply::Kind::no_session);
}

void SerialSession::lose(Time now) {
  answer_all(Reply::Kind::no_session);
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
    const Record hello = hello_of(session_);
    if (session_ != no_session &&
        std::count(hello.span().begin(), hello.span().end(), boot_loader_write) == 0) {
      break;
    }
  }
  reader_.expect(session_);
  say_hello(now);
}

void SerialSession::say_hello(Time now) {
  hello_at_ = now + hello_interval;
  if (line_is_clogged()) {
    return;
  }
  output_.push_back(delimiter);  // whatever the bridge has heard so far is over
  append_hello();
}

void SerialSession::append_hello() {
  const Record hello = hello_of(session_);
  output_.insert(output_.end(), hello.span().begin(), hello.span().end());
}

/// The bridge cannot do what it is to do, so nothing is sent to a bus where that might disturb.
void SerialSession::refuse(Status status, Time now) {
  lose(now);
  output_.clear();
  refusal_ = status;
  hello_at_ = now + refused_interval;
}

void SerialSession::go_on(Time now) {
  phase_ = Phase::setting_up;
  while (phase_ == Phase::setting_up && !asked_) {
    switch (set_up_step_) {
      case SetUp::speed:
        set_up_step_ = SetUp::bus;
        ask_speed(now);
        break;
      case SetUp::bus:
        set_up_step_ = SetUp::address;
        set_up_bus(now);
        break;
      case SetUp::address:
        set_up_step_ = SetUp::rules;
        if (settings_.address) {
          ask({Down::address, {settings_.address->subnet, settings_.address->node}, {}}, now);
        }
        break;
      case SetUp::rules:
        set_up_step_ = SetUp::done;
        if (settings_.rules) {
          ask({Down::filter, filter_payload(*settings_.rules), {}}, now);
        }
        break;
      case SetUp::done:
        phase_ = Phase::ready;
        ask_next(now);
        break;
    }
  }
}

/// Only if it is not so already: it takes the bridge off the bus for a moment.
void SerialSession::set_up_bus(Time now) {
  const std::uint32_t bitrate_bps = settings_.bitrate_bps.value_or(info_.bitrate_bps);
  const BridgeMode mode = settings_.mode.value_or(info_.mode);
  if (bitrate_bps == info_.bitrate_bps && mode == info_.mode) {
    return;
  }
  ask({Down::bus, bus_payload(bitrate_bps, mode),
       [this, bitrate_bps, mode](const Reply& reply) {
         if (is_kept(reply)) {
           info_.bitrate_bps = bitrate_bps;
           info_.mode = mode;
         }
       }},
      now);
}

Time SerialSession::deadline() const {
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
  Time first = std::min(heard_at_ + silence, poll_at_);
  if (asked_) {
    first = std::min(first, asked_->repeat_at);
  }
  if (phase_ == Phase::ready && down_.awaits_taking()) {
    first = std::min(first, progress_at_ + results_timeout);
  }
  return first;
}

void SerialSession::on_time(Time now) {
  if (phase_ == Phase::closed || now < deadline()) {
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
  if (asked_ && now >= asked_->repeat_at) {
    repeat_request(now);
  }
  if (phase_ == Phase::ready) {
    check_progress(now);
    send_frames(now);
  }
}

void SerialSession::consume_output(std::size_t count) {
  output_.erase(output_.begin(), output_.begin() + static_cast<std::ptrdiff_t>(count));
}

bool SerialSession::controller_works() const {
  return info_.state != BridgeState::no_controller && info_.state != BridgeState::stuck;
}

bool SerialSession::line_is_clogged() const {
  return output_.size() >= clogged;
}

// --- the line rate -------------------------------------------------------------------------------

/// If there is a better one than now. Nothing else is said until the reply.
void SerialSession::ask_speed(Time now) {
  const std::optional<std::uint32_t> rate_bps = line_rate_.ask();
  if (!rate_bps) {
    return;
  }
  phase_ = Phase::speeding;
  speed_until_ = now + speed_timeout;
  write_numbered(Down::speed, ++last_request_, speed_payload(*rate_bps));
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
  output_.assign(1, delimiter);
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

bool SerialSession::take_echoed(std::span<const std::uint8_t> payload, Time now) {
  const LineRate::Trial trial = line_rate_.take(payload);
  if (trial == LineRate::Trial::nonsense) {
    return false;
  }
  // Else one that was sent twice.
  if (phase_ == Phase::trying && trial == LineRate::Trial::failed) {
    fail_trial(now);
  } else if (phase_ == Phase::trying && trial == LineRate::Trial::passed) {
    go_on(now);
  }
  return true;
}

void SerialSession::fail_trial(Time now) {
  ++counters_.failed_trials;
  line_rate_.give_up();
  lose(now);
}

void SerialSession::step_down_if_needed(Time now) {
  if (phase_ != Phase::ready || asked_ || !line_rate_.step_down_if_due()) {
    return;
  }
  ++counters_.step_downs;
  set_up_step_ = SetUp::speed;
  go_on(now);
}

// --- requests ------------------------------------------------------------------------------------

void SerialSession::set_bus(std::uint32_t bitrate_bps, BridgeMode mode, Time now, Done done) {
  bitrate_bps = bitrate_bps == 0 ? info_.bitrate_bps : bitrate_bps;
  queue({Down::bus, bus_payload(bitrate_bps, mode),
         [this, bitrate_bps, mode, done = std::move(done)](const Reply& reply) {
           if (is_kept(reply)) {
             settings_.bitrate_bps = info_.bitrate_bps = bitrate_bps;
             settings_.mode = info_.mode = mode;
           }
           done(reply);
         }},
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
             info_.address = is_broadcast(address) ? std::nullopt : std::optional(address);
           }
           done(reply);
         }},
        now);
}

void SerialSession::identify(std::uint8_t seconds, Time now, Done done) {
  queue({Down::identify, {seconds}, std::move(done)}, now);
}

void SerialSession::leave(Time now, Done done) {
  answer_all(Reply::Kind::no_session);
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
  requests_.push_back(std::move(request));
  if (phase_ == Phase::ready) {
    ask_next(now);
  }
}

void SerialSession::ask_next(Time now) {
  if (asked_ || requests_.empty()) {
    return;
  }
  Request request = std::move(requests_.front());
  requests_.pop_front();
  ask(std::move(request), now);
}

void SerialSession::ask(Request request, Time now) {
  asked_.emplace(Asked{std::move(request), ++last_request_, 1, now});
  write_request(now);
}

void SerialSession::write_request(Time now) {
  const Request& request = asked_->request;
  asked_->repeat_at = now + interval_of(request.operation);
  write_numbered(request.operation, asked_->number, request.payload);
}

void SerialSession::repeat_request(Time now) {
  if (asked_->tries < max_tries) {
    ++asked_->tries;
    ++counters_.retries;
    write_request(now);
    return;
  }
  finish_request({Reply::Kind::unanswered, Status::ok});
  if (phase_ == Phase::setting_up) {
    lose(now);
  } else if (phase_ == Phase::ready) {
    ask_next(now);
  }
}

void SerialSession::finish_request(const Reply& reply) {
  const Done done = std::move(asked_->request.done);
  asked_.reset();
  if (done) {
    done(reply);
  }
}

void SerialSession::answer_all(Reply::Kind kind) {
  if (asked_) {
    finish_request({kind, Status::ok});
  }
  for (const Request& request : std::exchange(requests_, {})) {
    request.done({kind, Status::ok});
  }
}

bool SerialSession::take_reply(std::span<const std::uint8_t> payload, Time now) {
  if (payload.size() != reply_length - control_head) {
    return false;
  }
  const Reply reply{Reply::Kind::answered, static_cast<Status>(payload[1])};
  if (phase_ == Phase::speeding) {
    take_speed_reply(payload[0], reply, now);
  } else if (asked_ && asked_->number == payload[0]) {
    finish_request(reply);
    if (phase_ == Phase::ready) {
      ask_next(now);
    } else if (phase_ == Phase::setting_up && is_kept(reply)) {
      go_on(now);
    } else if (phase_ == Phase::setting_up) {
      refuse(reply.status, now);
    }
  }
  return true;  // also one to what was asked twice
}

void SerialSession::take_speed_reply(std::uint8_t number, const Reply& reply, Time now) {
  if (number != last_request_) {
    return;
  }
  if (reply.ok()) {
    begin_trial(now);
    return;
  }
  line_rate_.refused();
  set_up_step_ = SetUp::speed;
  go_on(now);
}

// --- frames down ---------------------------------------------------------------------------------

std::size_t SerialSession::offer(std::span<const Frame> frames, Time now) {
  if (phase_ != Phase::ready) {
    return 0;
  }
  const std::size_t count = down_.offer(frames);
  send_frames(now);
  return count;
}

void SerialSession::send_frames(Time now) {
  while (phase_ == Phase::ready && !line_is_clogged()) {
    if (!down_.awaits_taking()) {
      progress_at_ = now;
    }
    if (!down_.awaits_outcome()) {
      results_at_ = now;
    }
    const auto next = down_.next();
    if (!next) {
      return;
    }
    write(session_, [&](auto& writer) { put_frame_down(writer, next->frame, next->sequence); });
  }
}

bool SerialSession::take_results(std::span<const std::uint8_t> payload, Time now) {
  if (payload.size() != results_length - control_head) {
    return false;
  }
  const auto progress = down_.results(payload[0], get32(&payload[2]));
  if (progress == DownFrames::Progress::nonsense) {
    return false;
  }
  results_at_ = now;
  if (progress == DownFrames::Progress::some) {
    progress_at_ = now;
  }
  if ((payload[1] & again) != 0 && down_.awaits_taking()) {
    line_rate_.note_damaged_down();
    down_.go_back();
    progress_at_ = now;
  }
  return true;
}

void SerialSession::check_progress(Time now) {
  if (down_.awaits_taking() && now >= progress_at_ + results_timeout) {
    down_.go_back();
    progress_at_ = now;
  }
  if (down_.awaits_outcome() && controller_works() && now >= results_at_ + results_lost) {
    lose(now);
  }
}

// --- incoming records ----------------------------------------------------------------------------

void SerialSession::receive(std::span<const std::uint8_t> bytes, Time now) {
  for (const std::uint8_t byte : bytes) {
    if (phase_ == Phase::closed) {
      return;
    }
    const RecordReader::Event event = reader_.take(byte);
    if (event == RecordReader::Event::none) {
      continue;
    }
    if (event == RecordReader::Event::record &&
        reader_.is_intact(session_of(reader_.body()[0], session_))) {
      take_record({reader_.body(), reader_.length()}, now);
    } else {
      count_damaged(now);
    }
  }
  send_frames(now);
}

void SerialSession::take_record(std::span<const std::uint8_t> body, Time now) {
  line_rate_.note_intact();
  heard_at_ = now;
  const bool makes_sense = is_control(body[0]) ? take_control(body, now) : take_frame(body, now);
  if (!makes_sense) {
    count_damaged(now);
  }
}

/// While there is no session, anything may be on the line.
void SerialSession::count_damaged(Time now) {
  if (!in_session()) {
    return;
  }
  if (line_rate_.note_damaged()) {
    ++counters_.damaged;
  }
  step_down_if_needed(now);
}

bool SerialSession::take_control(std::span<const std::uint8_t> body, Time now) {
  const auto operation = static_cast<Up>(body[0]);
  const auto payload = body.subspan(control_head);
  if (operation == Up::welcome) {
    return take_welcome(payload, now);
  }
  if (!in_session()) {
    return true;  // WELCOME was lost; what comes before the next is as good as lost
  }
  up_.expect(body[1]);
  switch (operation) {
    case Up::status:
      return take_status(payload, now);
    case Up::counters:
      return take_counters(payload);
    case Up::results:
      return take_results(payload, now);
    case Up::reply:
      return take_reply(payload, now);
    case Up::echoed:
      return take_echoed(payload, now);
    default:
      return false;
  }
}

bool SerialSession::take_frame(std::span<const std::uint8_t> body, Time now) {
  Frame frame{};
  if (!read_frame(body.data(), static_cast<std::uint8_t>(body.size()), frame_head_up, frame)) {
    return false;
  }
  if (!in_session()) {
    return true;
  }
  if (repeated_.take(body)) {
    ++counters_.damaged;  // which a lower line rate would not mend
    return true;
  }
  up_.take(body[sequence_at]);
  const std::uint64_t lost_before = up_.lost() - std::exchange(lost_told_, up_.lost());
  arrived_.push_back({frame, clock_.frame(get16(&body[time_at]), now), lost_before});
  return true;
}

bool SerialSession::take_welcome(std::span<const std::uint8_t> payload, Time now) {
  if (payload.empty()) {
    return false;
  }
  if (payload[0] != protocol_version) {
    other_version_ = OtherVersion{payload[0], firmware_of(payload)};
    return true;
  }
  const std::optional<Welcome> welcome = read_welcome(payload);
  if (!welcome || welcome->session != session_) {
    return welcome.has_value();  // the answer to an old HELLO
  }
  if (phase_ == Phase::calling) {
    open_session(*welcome, now);
  } else if (!is_still(*welcome)) {
    lose(now);  // the board was reset, and takes this for the first it hears of the session
  } else {
    info_.osc_khz = welcome->info.osc_khz;
    info_.interrupt_wired = welcome->info.interrupt_wired;
  }
  return true;
}

void SerialSession::open_session(const Welcome& welcome, Time now) {
  if (welcome.previous_session != no_session && welcome.previous_session == last_session_) {
    up_.settle(welcome.previous_due);
  }
  previous_session_ = welcome.previous_session;
  info_ = welcome.info;
  questions_ = 0;
  impossible_ = 0;
  line_rate_.offer(welcome.rates, welcome.info.line_rate_matters);
  up_.begin();
  repeated_.begin();
  clock_.begin();
  last_session_ = session_;
  ++counters_.sessions;
  counters_wanted_ = true;
  other_version_.reset();
  refusal_.reset();
  set_up_step_ = SetUp::speed;
  phase_ = Phase::setting_up;
  poll(now);
  go_on(now);
}

/// Whether the bridge is the one that the session was opened with, and has what it was told.
bool SerialSession::is_still(const Welcome& welcome) const {
  const bool is_set_up =
      welcome.info.bitrate_bps == info_.bitrate_bps && welcome.info.mode == info_.mode;
  return welcome.previous_session == previous_session_ &&
         (is_set_up || asked_ || phase_ != Phase::ready);
}

bool SerialSession::take_status(std::span<const std::uint8_t> payload, Time now) {
  const std::optional<BridgeStatus> status = read_status(payload);
  if (!status) {
    return false;
  }
  if (!clock_.status(status->ticks, now) || !up_.settle(status->due)) {
    // One may be a record that the line repeats. Two: a board that was reset, and that HELLO has
    // brought into this session again.
    if (++impossible_ < max_impossible) {
      return false;
    }
    lose(now);
    return true;
  }
  impossible_ = 0;
  const BridgeState before = std::exchange(info_.state, status->state);
  info_.transmit_errors = status->transmit_errors;
  info_.receive_errors = status->receive_errors;
  counters_wanted_ = counters_wanted_ || before != info_.state;
  // WELCOME came before there was a controller, and could not say what crystal it has.
  if (info_.osc_khz == 0 && controller_works() && phase_ == Phase::ready && !asked_ &&
      !line_is_clogged() && questions_ < max_questions) {
    ++questions_;
    append_hello();
  }
  return true;
}

bool SerialSession::take_counters(std::span<const std::uint8_t> payload) {
  const CounterReports::Event event = reports_.take(payload);
  if (event == CounterReports::Event::complete) {
    counters_wanted_ = false;
  }
  return event != CounterReports::Event::nonsense;
}

// --- outgoing records ----------------------------------------------------------------------------

template <typename Body>
void SerialSession::write(std::uint32_t session, const Body& body) {
  Record record;
  RecordWriter<Record> writer(record, session);
  body(writer);
  record.length = writer.finish();
  output_.insert(output_.end(), record.span().begin(), record.span().end());
}

void SerialSession::write_control(Down operation, std::span<const std::uint8_t> payload) {
  write(session_, [&](auto& writer) {
    writer.put(static_cast<std::uint8_t>(operation));
    writer.put(down_.sequence());
    for (const std::uint8_t byte : payload) {
      writer.put(byte);
    }
  });
}

/// What is answered by REPLY.
void SerialSession::write_numbered(Down operation, std::uint8_t number,
                                   std::span<const std::uint8_t> payload) {
  std::vector<std::uint8_t> numbered{number};
  numbered.insert(numbered.end(), payload.begin(), payload.end());
  write_control(operation, numbered);
}

void SerialSession::poll(Time now) {
  poll_at_ = now + poll_interval;
  if (line_is_clogged()) {
    return;
  }
  counters_wanted_ = counters_wanted_ || polls_ % polls_per_counters == 0;
  ++polls_;
  write_control(Down::poll, std::array<std::uint8_t, 1>{std::uint8_t{counters_wanted_}});
}

BridgeInfo SerialSession::info() const {
  BridgeInfo info = info_;
  info.line_rate_bps = line_rate_bps();
  if (!in_session()) {
    info.state = BridgeState::absent;
  }
  return info;
}

}  // namespace roio
