#include <algorithm>
#include <iterator>
#include <roio/sim/controller.hpp>

#include "bus/frame_parser.hpp"
#include "bus/wire_bits.hpp"

namespace roio::sim {
namespace {

constexpr std::uint8_t integration_bits = 11;
constexpr std::uint8_t intermission_bits = 3;
constexpr std::uint8_t suspend_bits = 8;
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
    receive_errors_ = std::min(receive_errors_ - 1, receive_errors_after_success);
    confine();
  }
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

}  // namespace roio::sim
