// What a controller does when something is wrong: flags, counters, and whether it may still take
// part.
#include <algorithm>
#include <roio/sim/controller.hpp>

namespace roio::sim {
namespace {

constexpr std::uint8_t recovery_bits = 11;
constexpr std::uint8_t recovery_sequences = 128;
constexpr std::uint8_t flag_bits = 6;
constexpr std::uint8_t delimiter_bits = 8;
constexpr unsigned passive_limit = 128;
constexpr unsigned bus_off_limit = 256;
constexpr unsigned receive_errors_limit = 255;

}  // namespace

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

void Controller::reset_error_counters() {
  transmit_errors_ = 0;
  receive_errors_ = 0;
  confinement_ = Confinement::active;
}

Confinement Controller::confinement() const {
  return confinement_;
}

void Controller::sample_bus_off(std::uint8_t level) {
  count_ = level == recessive ? count_ + 1 : 0;
  if (count_ < recovery_bits) {
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
