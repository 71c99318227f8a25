#include "avr/usb_serial.hpp"

#include <algorithm>
#include <utility>

namespace roio::sim {
namespace {

using Cycle = AvrCore::Cycle;

constexpr Cycle frame_cycles = AvrCore::clock_hz / 1000;
// 12 Mbit/s; a transaction takes 13 bytes beside its data (USB 2.0, 5.8.4).
constexpr std::size_t overhead_bytes = 13;
constexpr Cycle cycles_of_three_bytes = 32;
// After two transactions that moved nothing: a host goes on at once, which would show nothing new.
constexpr Cycle idle_cycles = Cycle{20} * (AvrCore::clock_hz / 1'000'000);
// A PC waits for 100 ms, then resets for 10.
constexpr std::uint16_t reset_frame = 3;
constexpr std::uint16_t first_request_frame = 6;

constexpr std::size_t packet_bytes = 64;
/// Linux (cdc-acm) hands on what came when a packet is not full, or when there are so many bytes.
constexpr std::size_t handed_on_bytes = 128;
constexpr std::uint8_t device_address = 1;
// Requests
constexpr std::uint8_t to_device = 0x00;
constexpr std::uint8_t from_device = 0x80;
constexpr std::uint8_t to_class_interface = 0x21;
constexpr std::uint8_t set_address = 5;
constexpr std::uint8_t get_descriptor = 6;
constexpr std::uint8_t set_configuration = 9;
constexpr std::uint8_t set_line_coding = 0x20;
constexpr std::uint8_t set_control_line_state = 0x22;
constexpr std::uint16_t dtr_and_rts = 3;
// Descriptors
constexpr std::uint8_t device = 1;
constexpr std::uint8_t configuration = 2;
constexpr std::uint8_t interface = 4;
constexpr std::uint8_t endpoint = 5;
constexpr std::uint16_t device_length = 18;
constexpr std::uint16_t configuration_head_length = 9;
constexpr std::uint8_t class_communication = 2;
constexpr std::uint8_t class_data = 10;
constexpr std::uint8_t bulk_type = 2;
constexpr std::uint8_t endpoint_in = 0x80;

Cycle duration_of(std::size_t bytes) {
  return (overhead_bytes + bytes) * cycles_of_three_bytes / 3;
}

std::array<std::uint8_t, 8> setup_of(std::uint8_t type, std::uint8_t request, unsigned value,
                                     unsigned index, std::size_t length) {
  const auto low = [](std::size_t word) { return static_cast<std::uint8_t>(word); };
  const auto high = [](std::size_t word) { return static_cast<std::uint8_t>(word >> 8); };
  return {type,       request,     low(value),  high(value),
          low(index), high(index), low(length), high(length)};
}

}  // namespace

UsbSerial::UsbSerial(AvrCore& core) : core_(core), usb_(core) {
  usb_.on_attach([this](bool is_attached) { attached(is_attached); });
}

void UsbSerial::receive(std::span<const std::uint8_t> bytes) {
  to_board_.insert(to_board_.end(), bytes.begin(), bytes.end());
}

bool UsbSerial::hold(bool holds) {
  held_ = holds;
  return true;
}

void UsbSerial::reset() {
  usb_.reset();
}

// The plug. What was on its way to the board does not wait for the next time.
void UsbSerial::attached(bool is_attached) {
  core_.cancel<&UsbSerial::frame>(*this);
  core_.cancel<&UsbSerial::transact>(*this);
  if (!is_attached) {
    counters().unheard += to_board_.size();
    to_board_.clear();
    return;
  }
  step_ = Step::settle;
  address_ = 0;
  from_board_.clear();
  frames_ = 0;
  core_.at<&UsbSerial::frame>(core_.cycle() + frame_cycles, *this);
}

Cycle UsbSerial::frame(Cycle when) {
  ++frames_;
  if (frames_ == reset_frame && step_ == Step::settle) {
    usb_.bus_reset();
  } else if (frames_ >= reset_frame || step_ != Step::settle) {
    usb_.start_of_frame(frames_);
  }
  if (frames_ == first_request_frame && step_ == Step::settle) {
    begin(Step::device_descriptor);
    core_.at<&UsbSerial::transact>(when + duration_of(0), *this);
  }
  return when + frame_cycles;
}

Cycle UsbSerial::transact(Cycle when) {
  if (step_ == Step::refused) {
    return 0;
  }
  return step_ == Step::running ? bulk(when) : control(when);
}

// --- setting up ----------------------------------------------------------------------------------

UsbSerial::Transfer UsbSerial::transfer_of(Step step) const {
  // 115200 bit/s, 1 stop bit, no parity, 8 data bits
  static const Bytes line_coding{0x00, 0xC2, 0x01, 0x00, 0, 0, 8};
  switch (step) {
    case Step::device_descriptor:
      return {.setup = setup_of(from_device, get_descriptor, device << 8, 0, device_length)};
    case Step::address:
      return {.setup = setup_of(to_device, set_address, device_address, 0, 0)};
    case Step::configuration_head:
      return {.setup = setup_of(from_device, get_descriptor, configuration << 8, 0,
                                configuration_head_length)};
    case Step::configuration: {
      const std::size_t total = transfer_.data[2] | std::size_t{transfer_.data[3]} << 8;
      return {.setup = setup_of(from_device, get_descriptor, configuration << 8, 0, total)};
    }
    case Step::configure:
      return {.setup = setup_of(to_device, set_configuration, transfer_.data[5], 0, 0)};
    case Step::line_coding:
      return {.setup = setup_of(to_class_interface, set_line_coding, 0, control_interface_,
                                line_coding.size()),
              .data = line_coding};
    default:
      return {.setup = setup_of(to_class_interface, set_control_line_state, dtr_and_rts,
                                control_interface_, 0)};
  }
}

void UsbSerial::begin(Step step) {
  step_ = step;
  if (step != Step::running && step != Step::refused) {
    transfer_ = transfer_of(step);
  }
}

std::size_t UsbSerial::length() const {
  return transfer_.setup[6] | std::size_t{transfer_.setup[7]} << 8;
}

// A transfer has come to its end.
void UsbSerial::done() {
  const bool is_short = reads() && transfer_.data.size() < length();
  if (is_short || (step_ == Step::configuration && !find_port())) {
    return begin(Step::refused);
  }
  address_ = step_ == Step::address ? device_address : address_;
  begin(static_cast<Step>(static_cast<int>(step_) + 1));
}

// The interfaces and endpoints that make a serial port.
bool UsbSerial::find_port() {
  const Bytes& bytes = transfer_.data;
  std::uint8_t current_class = 0;
  in_endpoint_ = 0;
  out_endpoint_ = 0;
  for (std::size_t at = 0; at + 1 < bytes.size() && bytes[at] > 1; at += bytes[at]) {
    const std::size_t end = at + bytes[at];
    if (end > bytes.size()) {
      return false;
    }
    if (bytes[at + 1] == interface && bytes[at] >= 9) {
      current_class = bytes[at + 5];
      control_interface_ =
          current_class == class_communication ? bytes[at + 2] : control_interface_;
    } else if (bytes[at + 1] == endpoint && bytes[at] >= 7 && current_class == class_data &&
               (bytes[at + 3] & 3U) == bulk_type) {
      const unsigned number = bytes[at + 2] & 0x0FU;
      ((bytes[at + 2] & endpoint_in) != 0 ? in_endpoint_ : out_endpoint_) = number;
    }
  }
  return in_endpoint_ != 0 && out_endpoint_ != 0;
}

AvrUsb::Answer UsbSerial::transfer_data() {
  if (!reads()) {
    return usb_.out(0, transfer_.data);  // one packet holds all that is ever sent here
  }
  Bytes packet;
  const AvrUsb::Answer answer = usb_.in(0, packet);
  transfer_.data.insert(transfer_.data.end(), packet.begin(), packet.end());
  const bool is_last = packet.size() < packet_bytes || transfer_.data.size() >= length();
  return answer == AvrUsb::Answer::ack && !is_last ? AvrUsb::Answer::nak : answer;
}

AvrUsb::Answer UsbSerial::transfer_status() {
  Bytes nothing;
  return reads() ? usb_.out(0, {}) : usb_.in(0, nothing);
}

Cycle UsbSerial::control(Cycle when) {
  const AvrUsb::Answer answer = !usb_.listens_at(address_)        ? AvrUsb::Answer::none
                                : transfer_.stage == Stage::setup ? usb_.setup(transfer_.setup)
                                : transfer_.stage == Stage::data  ? transfer_data()
                                                                  : transfer_status();
  if (answer == AvrUsb::Answer::stall || answer == AvrUsb::Answer::none) {
    begin(Step::refused);
  } else if (answer == AvrUsb::Answer::ack) {
    switch (transfer_.stage) {
      case Stage::setup:
        transfer_.stage = length() != 0 ? Stage::data : Stage::status;
        break;
      case Stage::data:
        transfer_.stage = Stage::status;
        break;
      case Stage::status:
        done();
        break;
    }
  }
  return when + duration_of(packet_bytes);
}

// --- moving bytes --------------------------------------------------------------------------------

// One transaction, this way and that way in turn.
Cycle UsbSerial::bulk(Cycle when) {
  out_turn_ = !out_turn_;
  const Cycle end = out_turn_ ? bulk_out(when) : bulk_in(when);
  const bool moved = end != when;
  const bool rests = !moved && idle_;
  idle_ = !moved;
  return moved ? end : when + (rests ? idle_cycles : duration_of(0));
}

/// @return when it ends; now: there was nothing, or no room for it.
Cycle UsbSerial::bulk_out(Cycle when) {
  if (to_board_.empty()) {
    return when;
  }
  const std::size_t count = std::min(to_board_.size(), packet_bytes);
  const Bytes packet(to_board_.begin(), to_board_.begin() + static_cast<std::ptrdiff_t>(count));
  if (usb_.out(out_endpoint_, packet) != AvrUsb::Answer::ack) {
    return when;
  }
  to_board_.erase(to_board_.begin(), to_board_.begin() + static_cast<std::ptrdiff_t>(count));
  counters().received += count;
  return when + duration_of(count);
}

Cycle UsbSerial::bulk_in(Cycle when) {
  Bytes packet;
  if (held_ || usb_.in(in_endpoint_, packet) != AvrUsb::Answer::ack) {
    return when;
  }
  const Cycle end = when + duration_of(packet.size());
  counters().sent += packet.size();
  from_board_.insert(from_board_.end(), packet.begin(), packet.end());
  if (packet.size() < packet_bytes || from_board_.size() >= handed_on_bytes) {
    for (const std::uint8_t byte : std::exchange(from_board_, {})) {
      send(end, byte);
    }
  }
  return end;
}

}  // namespace roio::sim
