#include "line.hpp"

#include <algorithm>

#include "seed.hpp"

namespace roio::test {
namespace {

constexpr double bytes_between_faults = 28;  // about half of the records are hit

// Of a thousand faults, how many are of each kind; outages come on top, rarely.
struct Share {
  Fault fault;
  std::uint32_t of_1000;
};
constexpr std::array<Share, fault_count - 1> shares = {{{Fault::flipped, 330},
                                                        {Fault::replaced, 150},
                                                        {Fault::zeroed, 50},
                                                        {Fault::lost, 120},
                                                        {Fault::made_up, 100},
                                                        {Fault::made_up_zero, 30},
                                                        {Fault::repeated, 40},
                                                        {Fault::swapped, 40},
                                                        {Fault::lost_delimiter, 40},
                                                        {Fault::noise, 80},
                                                        {Fault::overrun, 20}}};
constexpr std::uint32_t faults_to_an_outage = 20'000;

Fault any_fault(Mix mix, std::mt19937& random) {
  if (mix == Mix::noise) {
    return Fault::noise;
  }
  if (up_to(random, faults_to_an_outage - 1) == 0) {
    return Fault::outage;
  }
  std::uint32_t drawn = up_to(random, 999);
  for (const Share& share : shares) {
    if (drawn < share.of_1000) {
      return share.fault;
    }
    drawn -= share.of_1000;
  }
  return Fault::flipped;
}

}  // namespace

Line::Line(Mix mix, std::mt19937& random) : mix_(mix), random_(random) {
  plan();
}

bool Line::carry(std::span<const std::uint8_t> bytes, std::vector<std::uint8_t>& arrived) {
  arrived_ = &arrived;
  whole_ = losing_ == 0 && changing_ == 0 && !held_;
  std::for_each(bytes.begin(), bytes.end(), [this](std::uint8_t byte) { pass(byte); });
  return whole_;
}

void Line::calm_down() {
  is_calm_ = true;
  losing_ = 0;
  changing_ = 0;
  loses_delimiter_ = false;
}

void Line::pass(std::uint8_t byte) {
  if (losing_ > 0) {
    --losing_;
  } else if (changing_ > 0) {
    --changing_;
    put(static_cast<std::uint8_t>(byte ^ (1 + up_to(random_, 254))));
  } else if (loses_delimiter_ && byte == 0) {
    loses_delimiter_ = false;
    whole_ = false;
  } else if (is_calm_ || --fault_in_ > 0) {
    put(byte);
  } else {
    whole_ = false;
    plan();
    strike(byte);
  }
}

void Line::strike(std::uint8_t byte) {
  const Fault fault = any_fault(mix_, random_);
  ++faults_[static_cast<std::size_t>(fault)];
  switch (fault) {
    case Fault::flipped:
      put_flipped(byte);
      break;
    case Fault::replaced:
      put(any_byte());
      break;
    case Fault::zeroed:
      put(0);
      break;
    case Fault::lost:
      break;
    case Fault::made_up:
      put(byte);
      for (std::uint32_t count = 1 + up_to(random_, 3); count > 0; --count) {
        put(any_byte());
      }
      break;
    case Fault::made_up_zero:
      put(0);
      put(byte);
      break;
    case Fault::repeated:
      put(byte);
      put(byte);
      break;
    case Fault::swapped:
      if (held_) {
        put(byte);
      } else {
        held_ = byte;
      }
      break;
    case Fault::lost_delimiter:
      loses_delimiter_ = byte != 0;
      if (loses_delimiter_) {
        put(byte);
      }
      break;
    case Fault::noise:
      changing_ = 3 + up_to(random_, mix_ == Mix::noise ? 2 : 37);
      pass(byte);
      break;
    case Fault::overrun:
      losing_ = 1 + up_to(random_, 98);
      break;
    case Fault::outage:
      losing_ = 6'000 + up_to(random_, 24'000);
      break;
  }
}

void Line::put(std::uint8_t byte) {
  arrived_->push_back(byte);
  last_ = byte;
  if (held_) {
    last_ = *held_;
    arrived_->push_back(last_);
    held_.reset();
  }
}

void Line::put_flipped(std::uint8_t byte) {
  std::uint32_t bits = 0;
  for (std::uint32_t count = 1 + up_to(random_, 2); count > 0; --count) {
    bits |= 1U << up_to(random_, 7);
  }
  put(static_cast<std::uint8_t>(byte ^ bits));
}

std::uint8_t Line::any_byte() {
  return static_cast<std::uint8_t>(up_to(random_, 0xFF));
}

void Line::plan() {
  fault_in_ = 1 + std::geometric_distribution<std::uint32_t>(1 / bytes_between_faults)(random_);
}

}  // namespace roio::test
