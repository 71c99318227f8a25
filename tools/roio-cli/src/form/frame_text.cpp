#include "form/frame_text.hpp"

#include <array>
#include <iterator>
#include <roio/message.hpp>
#include <roio/text.hpp>
#include <string_view>
#include <utility>

namespace roio::cli {
namespace {

constexpr std::string_view plain = "\033[0m";
constexpr std::string_view bold_yellow = "\033[1;33m";
constexpr std::string_view dim = "\033[2m";
constexpr std::string_view red = "\033[31m";

void append(Buffer& out, std::string_view text) {
  out.append(text.data(), text.data() + text.size());
}

// Bits of an error report's identifier. Source: linux/can/error.h.
constexpr std::array<std::pair<std::uint32_t, std::string_view>, 9> error_classes{{
    {0x001, "transmit timeout"},
    {0x002, "lost arbitration"},
    {0x004, "controller"},
    {0x008, "protocol violation"},
    {0x010, "transceiver"},
    {0x020, "no acknowledgement"},
    {0x040, "bus-off"},
    {0x080, "bus error"},
    {0x100, "restarted"},
}};

void append_error_classes(Buffer& out, std::uint32_t id) {
  std::string_view separator = "  ";
  for (const auto& [bit, name] : error_classes) {
    if ((id & bit) != 0) {
      append(out, separator);
      append(out, name);
      separator = ", ";
    }
  }
}

std::string_view spaces(Gap gap) {
  return gap == Gap::wide ? "  " : " ";
}

void append_data(Buffer& out, const Frame& frame, Gap gap) {
  fmt::format_to(std::back_inserter(out), "[{}]", frame.length);
  if (is_remote(frame.kind)) {
    append(out, spaces(gap));
    append(out, "remote request");
    return;
  }
  constexpr std::string_view digits = "0123456789ABCDEF";
  std::string_view separator = spaces(gap);
  for (std::uint8_t i = 0; i < frame.length && i < max_data_length; ++i) {
    append(out, separator);
    out.push_back(digits[frame.data[i] >> 4U]);
    out.push_back(digits[frame.data[i] & 0x0FU]);
    separator = " ";
  }
}

void append_message(Buffer& out, const Message& message, const Frame& frame, bool colour, Gap gap) {
  const bool urgent = message.header.priority == Priority::urgent;
  if (colour && urgent) {
    append(out, bold_yellow);
  }
  fmt::format_to(std::back_inserter(out), "{:<6} -> {:<6}{}{:<6}{}{:<7}{}",
                 to_string(message.header.source), to_string(message.header.destination),
                 spaces(gap), to_string(message.header.priority), spaces(gap),
                 to_string(message.header.message_class), spaces(gap));
  append_data(out, frame, gap);
  if (colour && urgent) {
    append(out, plain);
  }
}

// How wide all is that stands before a message's length.
int width_before_length(Gap gap) {
  return gap == Gap::wide ? 35 : 32;
}

// A frame that is no message: what it is, and its identifier, where a message has its addresses.
void append_other(Buffer& out, std::string_view what, const std::string& id, Gap gap) {
  const std::string text = std::string(what) + std::string(spaces(gap)) + id;
  fmt::format_to(std::back_inserter(out), "{:<{}}", text, width_before_length(gap));
}

void append_foreign(Buffer& out, const Frame& frame, Status why, Gap gap) {
  append_other(out, "foreign",
               is_extended(frame.kind) ? fmt::format("29-bit {:08X}", frame.id)
                                       : fmt::format("11-bit {:03X}", frame.id),
               gap);
  append_data(out, frame, gap);
  if (why == Status::unknown_class) {
    append(out, "  (reserved class)");
  } else if (why == Status::bad_argument) {
    append(out, "  (broadcast as source)");
  }
}

void append_error(Buffer& out, const Frame& frame, Gap gap) {
  append_other(out, "error  ", fmt::format("{:08X}", frame.id), gap);
  append_data(out, frame, gap);
  append_error_classes(out, frame.id);
}

}  // namespace

void append_frame(Buffer& out, const Frame& frame, bool colour, Gap gap) {
  Message message{};
  const Status status = to_message(frame, message);
  if (status == Status::ok) {
    append_message(out, message, frame, colour, gap);
    return;
  }
  const bool error = frame.kind == FrameKind::error;
  if (colour) {
    append(out, error ? red : dim);
  }
  if (error) {
    append_error(out, frame, gap);
  } else {
    append_foreign(out, frame, status, gap);
  }
  if (colour) {
    append(out, plain);
  }
}

bool is_roio(const Frame& frame) noexcept {
  Message message{};
  return to_message(frame, message) == Status::ok;
}

void TimeColumn::append(Buffer& out, Timestamp time) {
  using std::chrono::duration_cast;
  using std::chrono::microseconds;
  constexpr std::int64_t second_us = 1'000'000;
  if (mode_ == Mode::none) {
    return;
  }
  if (mode_ == Mode::absolute) {
    const auto us = duration_cast<microseconds>(time.time_since_epoch()).count();
    fmt::format_to(std::back_inserter(out), "({:010}.{:06}) ", us / second_us, us % second_us);
    return;
  }
  const auto passed = std::max(time - reference_.value_or(time), Timestamp::duration::zero());
  if (mode_ == Mode::delta || !reference_) {
    reference_ = time;
  }
  const auto us = duration_cast<microseconds>(passed).count();
  fmt::format_to(std::back_inserter(out), "({:03}.{:06}) ", us / second_us, us % second_us);
}

}  // namespace roio::cli
