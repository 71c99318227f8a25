#include <algorithm>
#include <iterator>
#include <roio/sim/controller.hpp>

#include "bus/frame_parser.hpp"
#include "bus/wire_bits.hpp"

namespace roio::sim {
namespace {

constexpr std::uint8_t integration_bits = 11;
constexpr std::uint8_t recovery_sequences = 128;
constexpr std::uint8_t flag_bits = 6;
constexpr std::uint8_t delimiter_bits = 8;
constexpr std::uint8_t intermission_bits = 3;
constexpr std::uint8_t suspend_bits = 8;
constexpr unsigned passive_limit = 128;
constexpr unsigned bus_off_limit = 256;
constexpr unsigned receive_errors_limit = 255;
// After a success, a receive error counter above 127 is set to a value from 119 to 127.
constexpr unsigned receive_errors_after_success = 127;

// The tail of every frame, bit by bit.
constexpr std::uint8_t crc_delimiter_at = 0;
constexpr std::uint8_t acknowledge_slot_at = 1;
constexpr std::uint8_t acknowledge_delimiter_at = 2;
constexpr std::uint8_t received_at = 8;  // the last bit but one
constexpr std::uint8_t end_at = 9;       // the seventh bit of end-of-frame

bool is_same(const Frame& a, const Frame& b) {
  return a.id == b.id && a.kind == b.kind && a.length == b.length &&
         std::equal(std::begin(a.data), std::end(a.data), std::begin(b.data));
}

}  // namespace

const char* to_string(BusError error) {
  switch (error) {
    case BusError::bit:
      return "bit error";
    case BusError::stuff:
      return "stuff error";
    case BusError::crc:
      return "CRC error";
    case BusError::form:
      return "form error";
    case BusError::acknowledge:
      return "no acknowledgement";
  }
  return "unknown error";
}

struct Controller::Parts {
  FrameParser parser;
  WireBits sending;
  std::uint8_t sent = 0;  // bits of `sending` that are on the wire
};

Controller::Controller(ControllerClient& client)
    : client_(client), parts_(std::make_unique<Parts>()) {}

Controller::~Controller() = default;

void Controller::enter(State state, std::uint8_t output) {
  state_ = state;
  output_ = output;
  count_ = 0;
}

void Controller::set_mode(Mode mode) {
  mode_ = mode;
  transmitting_ = false;
  was_transmitter_ = false;
  if (mode == Mode::off || mode == Mode::asleep) {
    enter(mode == Mode::off ? State::off : State::asleep, recessive);
  } else if (confinement_ == Confinement::bus_off) {
    sequences_ = 0;
    enter(State::bus_off, recessive);
  } else {
    enter(State::integrating, recessive);
  }
}

void Controller::reset_error_counters() {
  transmit_errors_ = 0;
  receive_errors_ = 0;
  confinement_ = Confinement::active;
}

Confinement Controller::confinement() const {
  return confinement_;
}

// --- one bit -------------------------------------------------------------------------------------

void Controller::sample_outside_frame(std::uint8_t level) {
  switch (state_) {
    case State::frame:  // is sample_frame()'s
    case State::off:
      return;
    case State::asleep:
      if (level == dominant) {
        client_.on_bus_activity();
      }
      return;
    case State::integrating:
      count_ = level == recessive ? count_ + 1 : 0;
      if (count_ == integration_bits) {
        enter(State::idle, recessive);
        client_.on_integrated();
      }
      return;
    case State::bus_off:
      return sample_bus_off(level);
    case State::suspended:
      return sample_suspended(level);
    case State::idle:
      if (level == dominant) {
        start_frame(level);
      }
      return;
    case State::tail:
      return sample_tail(level);
    case State::error_flag:
    case State::overload_flag:
      return sample_flag(level);
    case State::flag_end:
      return sample_flag_end(level);
    case State::delimiter:
      return sample_delimiter(level);
    case State::intermission:
      return sample_intermission(level);
  }
}

// --- a frame, up to the CRC ----------------------------------------------------------------------

void Controller::try_to_start() {
  if (mode_ != Mode::normal) {
    return;
  }
  const std::optional<Submission> next = client_.next_submission();
  if (!next) {
    requested_ = false;
    return;
  }
  // Most attempts are repeated ones: arbitration was lost.
  if (parts_->sending.size == 0 || !is_same(submission_.frame, next->frame)) {
    parts_->sending = wire_bits_of(next->frame);
  }
  submission_ = *next;
  parts_->sent = 0;
  parts_->parser.start();
  transmitting_ = true;
  was_transmitter_ = true;
  enter(State::frame, parts_->sending.bits.front());
}

// Somebody else's start of frame. The frame is received from here on.
void Controller::start_frame(std::uint8_t level) {
  transmitting_ = false;
  was_transmitter_ = false;
  enter(State::frame, recessive);
  parts_->parser.start();
  parts_->parser.put(level);
}

void Controller::sample_frame(std::uint8_t level) {
  if (transmitting_ && !sample_own_bit(level)) {
    return;
  }
  switch (parts_->parser.put(level)) {
    case FrameParser::Step::stuff_error:
      return fail(BusError::stuff);
    case FrameParser::Step::complete:
      return end_of_crc();
    case FrameParser::Step::more:
      return set_next_output();
  }
}

/// Compares what was sent with what the wire made of it. False when that ended the frame.
bool Controller::sample_own_bit(std::uint8_t level) {
  const std::uint8_t index = parts_->sent++;
  if (level == output_) {
    return true;
  }
  if (output_ == dominant || index > parts_->sending.arbitration_end) {
    fail(BusError::bit);
    return false;
  }
  if (parts_->parser.expects_stuff_bit()) {
    // A recessive stuff bit overwritten during arbitration: no error to count (CAN 2.0B, 8, rule 3,
    // exception 2).
    fail(BusError::stuff, 0);
    return false;
  }
  lose_arbitration();
  return true;
}

void Controller::lose_arbitration() {
  transmitting_ = false;
  was_transmitter_ = false;
  output_ = recessive;
  if (monitor_ != nullptr) {
    monitor_->on_arbitration_lost(*this);
  }
  client_.on_arbitration_lost();
}

void Controller::set_next_output() {
  output_ = transmitting_ ? parts_->sending.bits[parts_->sent] : recessive;
}

void Controller::end_of_crc() {
  crc_matches_ = parts_->parser.crc_matches();
  enter(State::tail, recessive);
}

// --- its tail ------------------------------------------------------------------------------------

void Controller::sample_tail(std::uint8_t level) {
  const std::uint8_t at = count_++;
  switch (at) {
    case crc_delimiter_at:
      if (level == dominant) {
        return fail(transmitting_ ? BusError::bit : BusError::form);
      }
      if (!transmitting_ && crc_matches_ && mode_ == Mode::normal) {
        output_ = dominant;
      }
      return;
    case acknowledge_slot_at:
      return sample_acknowledge_slot(level);
    case acknowledge_delimiter_at:
      if (level == dominant) {
        return fail(BusError::form);
      }
      if (!transmitting_ && !crc_matches_) {
        return fail(BusError::crc);
      }
      return;
    default:
      return sample_end_of_frame(level);
  }
}

void Controller::sample_acknowledge_slot(std::uint8_t level) {
  if (transmitting_ && level == recessive) {
    return fail(BusError::acknowledge);
  }
  if (output_ == dominant && level == recessive) {
    return fail(BusError::bit);
  }
  if (output_ == dominant) {
    acknowledged();
  }
}

void Controller::sample_end_of_frame(std::uint8_t level) {
  const auto at = static_cast<std::uint8_t>(count_ - 1U);
  if (level == dominant) {
    // For a receiver the frame is whole by now: the last bit is not looked at as part of it.
    if (at == end_at && !transmitting_) {
      return overload();
    }
    return fail(transmitting_ ? BusError::bit : BusError::form);
  }
  if (at == received_at && !transmitting_) {
    client_.on_received(parts_->parser.frame());
  } else if (at == end_at) {
    enter(State::intermission, recessive);
    if (transmitting_) {
      transmitted();  // last: the owner may switch the mode
    }
  }
}

void Controller::transmitted() {
  transmitting_ = false;
  if (transmit_errors_ > 0) {
    --transmit_errors_;
    confine();
  }
  if (monitor_ != nullptr) {
    monitor_->on_transmitted(*this);
  }
  client_.on_transmitted();
}

// Received without error up to the acknowledge slot, and acknowledged: that is what the counter
// goes by (rule 8), although the frame is not whole yet.
void Controller::acknowledged() {
  output_ = recessive;
  if (receive_errors_ > 0) {
    receive_errors_ =
        receive_errors_ < passive_limit ? receive_errors_ - 1 : receive_errors_after_success;
    confine();
  }
}

// --- errors --------------------------------------------------------------------------------------

// Rules 1 and 3.
void Controller::fail(BusError error) {
  fail(error, was_transmitter_ ? 8 : 1);
}

void Controller::fail(BusError error, unsigned amount) {
  const bool in_own_frame = transmitting_;
  transmitting_ = false;
  if (mode_ == Mode::listen_only) {
    client_.on_receive_error(error);
    return enter(State::integrating, recessive);
  }
  passive_flag_ = confinement_ == Confinement::passive;
  // A lone node stays error-passive: nobody is there to acknowledge (rule 3, exception 1).
  owed_acknowledge_error_ = passive_flag_ && in_own_frame && error == BusError::acknowledge;
  after_error_flag_ = true;
  enter(State::error_flag, passive_flag_ ? recessive : dominant);
  equal_level_ = recessive;
  if (amount > 0 && !owed_acknowledge_error_) {
    count_error(amount);
  }
  if (in_own_frame) {
    if (monitor_ != nullptr) {
      monitor_->on_transmit_error(*this);
    }
    client_.on_transmit_error(error);
  } else {
    client_.on_receive_error(error);
  }
}

void Controller::overload() {
  if (mode_ == Mode::listen_only) {
    return enter(State::integrating, recessive);
  }
  passive_flag_ = false;
  after_error_flag_ = false;
  owed_acknowledge_error_ = false;
  enter(State::overload_flag, dominant);
}

void Controller::sample_flag(std::uint8_t level) {
  if (!passive_flag_) {
    if (level == recessive) {
      // A flag that does not show on the wire is an error in itself, and begins anew (rules 4 and
      // 5; ISO 16845-1, 8.6.1).
      return fail(BusError::bit, 8);
    }
    ++count_;
  } else {
    if (level == dominant && owed_acknowledge_error_) {
      owed_acknowledge_error_ = false;
      count_error(8);
      if (state_ != State::error_flag) {
        return;
      }
    }
    // Complete after six equal bits, whoever made them.
    count_ = level == equal_level_ ? count_ + 1 : 1;
    equal_level_ = level;
  }
  if (count_ == flag_bits) {
    enter(State::flag_end, recessive);
  }
}

void Controller::sample_flag_end(std::uint8_t level) {
  if (level == recessive) {
    enter(State::delimiter, recessive);
    count_ = 1;
    return;
  }
  ++count_;
  // A receiver that sees a dominant bit right after its flag was the first to find the error (rule
  // 2). Who holds the bus down any longer is the more wrong, eight bits at a time (rule 6).
  if (count_ == 1 && after_error_flag_ && !was_transmitter_) {
    count_error(8);
  } else if (count_ == 8) {
    count_ = 0;
    after_error_flag_ = false;
    count_error(8);
  }
}

void Controller::sample_delimiter(std::uint8_t level) {
  ++count_;
  if (level == dominant) {
    return count_ == delimiter_bits ? overload() : fail(BusError::form);
  }
  if (count_ == delimiter_bits) {
    enter(State::intermission, recessive);
  }
}

void Controller::count_error(unsigned amount) {
  if (mode_ != Mode::normal) {
    return;
  }
  if (was_transmitter_) {
    transmit_errors_ += amount;
  } else {
    receive_errors_ = std::min(receive_errors_ + amount, receive_errors_limit);
  }
  confine();
}

void Controller::confine() {
  const bool passive = transmit_errors_ >= passive_limit || receive_errors_ >= passive_limit;
  confinement_ = passive ? Confinement::passive : Confinement::active;
  if (transmit_errors_ >= bus_off_limit) {
    confinement_ = Confinement::bus_off;
    sequences_ = 0;
    enter(State::bus_off, recessive);
  }
  client_.on_confinement_changed();
}

// --- between frames ------------------------------------------------------------------------------

void Controller::sample_intermission(std::uint8_t level) {
  ++count_;
  const bool suspends = was_transmitter_ && confinement_ == Confinement::passive;
  if (count_ < intermission_bits) {
    return level == dominant ? overload() : void();
  }
  enter(suspends ? State::suspended : State::idle, recessive);
  if (level == dominant) {
    // Somebody's start of frame, one bit early. Who has something to send takes it for its own and
    // goes on with the identifier (CAN 2.0B, 3.2.5 "Interframe spacing").
    if (state_ == State::idle && requested_) {
      try_to_start();
    }
    sample(level);
  }
}

void Controller::sample_suspended(std::uint8_t level) {
  if (level == dominant) {
    return start_frame(level);
  }
  if (++count_ == suspend_bits) {
    enter(State::idle, recessive);
  }
}

void Controller::sample_bus_off(std::uint8_t level) {
  count_ = level == recessive ? count_ + 1 : 0;
  if (count_ < integration_bits) {
    return;
  }
  count_ = 0;
  if (++sequences_ == recovery_sequences) {
    reset_error_counters();
    was_transmitter_ = false;
    enter(State::idle, recessive);
    client_.on_confinement_changed();
  }
}

}  // namespace roio::sim
