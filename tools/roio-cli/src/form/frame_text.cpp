#include "form/frame_text.hpp"

#include <algorithm>
#include <array>
#include <ctime>
#include <iterator>
#include <roio/message.hpp>
#include <roio/text.hpp>
#include <string_view>
#include <utility>

namespace roio::cli {
namespace {

constexpr std::int64_t second_us = 1'000'000;

constexpr std::string_view plain = "\033[0m";
constexpr std::string_view bold_yellow = "\033[1;33m";
constexpr std::string_view bold = "\033[1m";
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

// Not red, which is an error's, nor what is hard to read on black or on white.
constexpr std::array<std::string_view, 6> source_colours{
    "\033[32m", "\033[36m", "\033[35m", "\033[34m", "\033[33m", "\033[96m",
};

// Neighbours in a subnet have different ones.
std::string_view colour_of(Address source) {
  constexpr std::size_t nodes = 256;
  return source_colours[(source.subnet * nodes + source.node) % source_colours.size()];
}

// @return whether it has begun one.
bool begin_colour(Buffer& out, const Header& header, Colour colour) {
  const bool urgent = header.priority == Priority::urgent;
  if (colour == Colour::sources) {
    append(out, colour_of(header.source));
    append(out, urgent ? bold : "");
    return true;
  }
  if (colour == Colour::kinds && urgent) {
    append(out, bold_yellow);
    return true;
  }
  return false;
}

// A line without fields ends with the message's name.
void trim(Buffer& out) {
  while (out.size() > 0 && out[out.size() - 1] == ' ') {
    out.resize(out.size() - 1);
  }
}

void append_named(Buffer& out, const Message& message, const Frame& frame, Gap gap,
                  const Labels& labels) {
  const MessageLabel label = labels.message(message);
  const std::size_t width = labels.address_width();
  fmt::format_to(std::back_inserter(out), "{:<{}} -> {:<{}}{}{:<6}{}{:<{}}{}",
                 labels.address(message.header.source), width,
                 labels.address(message.header.destination), width, spaces(gap),
                 to_string(message.header.priority), spaces(gap),
                 label.is_named ? label.name : to_string(message.header.message_class),
                 labels.message_width(), spaces(gap));
  if (!label.is_named) {
    append_data(out, frame, gap);
  } else if (!label.fields.empty()) {
    append(out, label.fields);
  } else {
    trim(out);
  }
}

void append_message(Buffer& out, const Message& message, const Frame& frame, Colour colour, Gap gap,
                    const Labels& labels) {
  const bool coloured = begin_colour(out, message.header, colour);
  append_named(out, message, frame, gap, labels);
  if (coloured) {
    append(out, plain);
  }
}

// How wide all is that stands before a message's length.
std::size_t width_before_length(Gap gap, const Labels& labels) {
  constexpr std::size_t arrow = 4;
  constexpr std::size_t priority = 6;
  constexpr std::size_t gaps = 3;
  return 2 * labels.address_width() + arrow + priority + labels.message_width() +
         gaps * spaces(gap).size();
}

// A frame that is no message: what it is, and its identifier, where a message has its addresses.
void append_other(Buffer& out, std::string_view what, const std::string& id, Gap gap,
                  const Labels& labels) {
  const std::string text = std::string(what) + std::string(spaces(gap)) + id;
  fmt::format_to(std::back_inserter(out), "{:<{}}", text, width_before_length(gap, labels));
}

void append_foreign(Buffer& out, const Frame& frame, Status why, Gap gap, const Labels& labels) {
  append_other(out, "foreign",
               is_extended(frame.kind) ? fmt::format("29-bit {:08X}", frame.id)
                                       : fmt::format("11-bit {:03X}", frame.id),
               gap, labels);
  append_data(out, frame, gap);
  if (why == Status::unknown_class) {
    append(out, "  (reserved class)");
  } else if (why == Status::bad_argument) {
    append(out, "  (broadcast as source)");
  }
}

void append_error(Buffer& out, const Frame& frame, Gap gap, const Labels& labels) {
  append_other(out, "error  ", fmt::format("{:08X}", frame.id), gap, labels);
  append_data(out, frame, gap);
  append_error_classes(out, frame.id);
}

}  // namespace

void append_frame(Buffer& out, const Frame& frame, Colour colour, Gap gap, const Labels* names) {
  const Labels& labels = names != nullptr ? *names : numeric_labels();
  Message message{};
  const Status status = to_message(frame, message);
  if (status == Status::ok) {
    append_message(out, message, frame, colour, gap, labels);
    return;
  }
  const bool error = frame.kind == FrameKind::error;
  const bool coloured = colour != Colour::none;
  if (coloured) {
    append(out, error ? red : dim);
  }
  if (error) {
    append_error(out, frame, gap, labels);
  } else {
    append_foreign(out, frame, status, gap, labels);
  }
  if (coloured) {
    append(out, plain);
  }
}

bool is_roio(const Frame& frame) noexcept {
  Message message{};
  return to_message(frame, message) == Status::ok;
}

void TimeColumn::append(Buffer& out, Timestamp time) {
  using std::chrono::microseconds;
  switch (mode_) {
    case Mode::none:
      return;
    case Mode::absolute: {
      const auto us = std::chrono::duration_cast<microseconds>(time.time_since_epoch()).count();
      fmt::format_to(std::back_inserter(out), "({:010}.{:06}) ", us / second_us, us % second_us);
      return;
    }
    case Mode::date:
      append_date(out, time);
      return;
    case Mode::delta:
    case Mode::zero:
      append_passed(out, time);
      return;
  }
}

// The date changes once a second, the frames thousands of times.
void TimeColumn::append_date(Buffer& out, Timestamp time) {
  const auto second = std::chrono::floor<std::chrono::seconds>(time);
  if (dated_ != second) {
    dated_ = second;
    const std::time_t seconds = second.time_since_epoch().count();
    std::tm parts{};
    ::localtime_r(&seconds, &parts);
    date_ = fmt::format("({:04}-{:02}-{:02} {:02}:{:02}:{:02}", parts.tm_year + 1900,
                        parts.tm_mon + 1, parts.tm_mday, parts.tm_hour, parts.tm_min, parts.tm_sec);
  }
  const auto us = std::chrono::duration_cast<std::chrono::microseconds>(time - second).count();
  fmt::format_to(std::back_inserter(out), "{}.{:06}) ", date_, us);
}

void TimeColumn::append_passed(Buffer& out, Timestamp time) {
  const auto passed = std::max(time - reference_.value_or(time), Timestamp::duration::zero());
  if (mode_ == Mode::delta || !reference_) {
    reference_ = time;
  }
  const auto us = std::chrono::duration_cast<std::chrono::microseconds>(passed).count();
  fmt::format_to(std::back_inserter(out), "({:03}.{:06}) ", us / second_us, us % second_us);
}

}  // namespace roio::cli
