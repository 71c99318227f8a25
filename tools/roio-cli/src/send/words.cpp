#include "send/words.hpp"

#include <algorithm>
#include <limits>
#include <roio/candump_log.hpp>
#include <roio/message.hpp>
#include <roio/text.hpp>
#include <span>

#include "program/words.hpp"

namespace roio::cli {
namespace {

constexpr const char* examples = R"(Examples:
  roio-cli send can0 0.2 5A2D00            three bytes to node 2 of subnet 0
  roio-cli send can0 0.2 5A 2D 00          the same, as dump prints them
  roio-cli send can0 0.2 --dec 90 45 0     the same, in decimal
  roio-cli send can0 1000400A#5A2D00       the same, as cansend takes it
  roio-cli send can0 123#R4                any other frame, as it is
  roio-cli send --urgent can0 '0.*' 00     urgent, to everybody in subnet 0
  roio-cli send --count 10 --interval 100 can0 0.2 01
  roio-cli send --wait local:robot 0.2 01  once somebody listens
  roio-cli send can0 - < messages.json     a message a line, as JSON
  roio-cli send can1 - < candump.log       what candump -L or dump --log kept

Without DATA the message is empty. Lines read from standard input say themselves
where they go. A line that cannot be understood is named on standard error, the
others are sent, and the exit status is 1. Quote '0.*' for the shell, or write
0.255. A local bus on which nobody listens is told on standard error.)";

constexpr const char* empty_message = "; without DATA the message is empty";

Bytes parse_decimal(std::span<const std::string> words) {
  if (words.empty()) {
    throw UsageError(std::string("--dec: expected 1 to 8 numbers 0..255 after DEST") +
                     empty_message);
  }
  Bytes bytes;
  if (words.size() > bytes.data.size()) {
    throw UsageError("DATA: expected at most 8 bytes, found " + std::to_string(words.size()));
  }
  for (const std::string& word : words) {
    bytes.data[bytes.length++] =
        static_cast<std::uint8_t>(parse_number("DATA with --dec", word, 0, 255));
  }
  return bytes;
}

// In one word, or in several, as dump prints them.
Bytes parse_hexadecimal(std::span<const std::string> words) {
  std::string text;
  for (const std::string& word : words) {
    if (word.empty()) {
      throw UsageError(std::string("DATA: expected hexadecimal digits such as 5A2D00, found \"\"") +
                       empty_message);
    }
    text += (text.empty() ? "" : " ") + word;
  }
  return value_or_refuse(parse_hex(text));
}

MessageClass parse_sendable_class(const std::string& text) {
  const auto message_class = parse_class(text);
  if (!message_class || *message_class == MessageClass::reserved) {
    throw UsageError("--class: expected message, system or stream, found " + quote(text));
  }
  return *message_class;
}

bool is_frame(const std::string& destination) {
  return destination.find('#') != std::string::npos;
}

}  // namespace

SendWords::SendWords(CLI::App& program)
    : app_(program.add_subcommand("send", "Send a message, or lines of them")),
      dec_(flag(*app_, "--dec", "DATA are decimal numbers, one a byte: 90 45 0")),
      from_(option(*app_, "--from", from_text_, "SUBNET.NODE", "Source address (default 0.10)")),
      urgent_(flag(*app_, "--urgent", "Ahead of normal messages")),
      message_class_(
          option(*app_, "--class", class_text_, "NAME", "message (default), system or stream")),
      count_(option(*app_, "--count", count_text_, "N", "Send N times; 0: until interrupted")),
      interval_(
          option(*app_, "--interval", interval_text_, "MS", "Time from one message to the next")) {
  prepare(*app_, "send [OPTIONS] BUS DEST|ID#DATA|- [DATA...]", examples);
  without_type(app_->add_option("BUS", bus_, "can0, local:NAME or serial:DEVICE"));
  without_type(app_->add_option("DEST", destination_,
                                "SUBNET.NODE, SUBNET.* (everybody there), or -: lines"));
  without_type(app_->add_option("DATA", data_, "1 to 8 bytes in hexadecimal: 5A2D00"));
  option(*app_, "--timeout", timeout_text_, "MS",
         "Longest wait of a message for the bus (default 1000)");
  wait_ = app_->add_flag("--wait{10000}", wait_text_, "Wait until somebody listens on a local bus")
              ->type_name("MS");
}

SendOptions SendWords::parse_options() const {
  constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
  SendOptions options;
  if (from_->count() > 0) {
    options.source = value_or_refuse(parse_source(from_text_), "--from: ");
  }
  options.count = parse_number("--count", count_text_, 0, most);
  options.interval = parse_ms("--interval", interval_text_, 0);
  options.timeout = parse_ms("--timeout", timeout_text_, 1);
  if (wait_->count() > 0) {
    options.wait = parse_ms("--wait", wait_text_, 1);
  }
  static_cast<void>(parse_sendable_class(class_text_));
  return options;
}

SendOptions SendWords::parse() const {
  refuse_rest(*app_, "send");
  // First the options: in `send --count local:robot 0.2`, what is wrong is not that BUS is missing.
  SendOptions options = parse_options();
  if (bus_.empty()) {
    refuse("send", "expected BUS, DEST and DATA");
  }
  if (destination_.empty()) {
    refuse("send", "expected DEST after BUS: SUBNET.NODE, SUBNET.*, ID#DATA or -");
  }
  options.bus = parse_bus(bus_);
  if (options.wait && parse_bus_url(bus_)->kind != BusUrl::Kind::local) {
    throw UsageError("--wait: expected with local:NAME alone; on " + bus_ +
                     " nobody can tell who listens");
  }
  if (destination_ == "-") {
    refuse_with("DEST -", "each line of the input", true);
    return options;
  }
  if (interval_->count() > 0 && count_->count() == 0) {
    throw UsageError("--interval: expected with --count N (0: until interrupted)");
  }
  options.frame = is_frame(destination_) ? parse_frame() : parse_message(options.source);
  return options;
}

// Which options make no sense with what says everything itself.
void SendWords::refuse_with(const char* what, const char* who, bool count_too) const {
  std::vector<const CLI::Option*> options{dec_, urgent_, message_class_};
  options.push_back(count_too ? count_ : from_);
  for (const CLI::Option* option : options) {
    if (option->count() > 0) {
      throw UsageError(option->get_name() + ": expected without " + what + ", as " + who +
                       " says its own");
    }
  }
  if (!data_.empty()) {
    throw UsageError(std::string("DATA: expected none after ") + what + ", as " + who +
                     " has its own");
  }
}

Frame SendWords::parse_frame() const {
  const Frame frame = value_or_refuse(parse_frame_text(destination_));
  if (frame.kind == FrameKind::error) {
    throw UsageError("frame " + quote(destination_) +
                     ": a controller's error report; expected a frame to send");
  }
  refuse_with("ID#DATA", "the frame", false);
  return frame;
}

Frame SendWords::parse_message(Address source) const {
  Message message{};
  message.header.destination = value_or_refuse(parse_address(destination_));
  message.header.source = source;
  message.header.priority = urgent_->count() > 0 ? Priority::urgent : Priority::normal;
  message.header.message_class = parse_sendable_class(class_text_);
  const Bytes bytes = dec_->count() > 0 ? parse_decimal(data_) : parse_hexadecimal(data_);
  message.length = bytes.length;
  std::copy(bytes.data.begin(), bytes.data.end(), message.data);
  Frame frame{};
  if (to_frame(message, frame) != Status::ok) {
    throw UsageError("not a message that can be sent");  // the options allow none such
  }
  return frame;
}

}  // namespace roio::cli
