#include "send/words.hpp"

#include <algorithm>
#include <limits>
#include <roio/candump_log.hpp>
#include <roio/message.hpp>
#include <roio/text.hpp>
#include <utility>

#include "program/words.hpp"
#include "send/message_words.hpp"

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

}  // namespace

SendWords::SendWords(CLI::App& program)
    : app_(program.add_subcommand("send", "Send a message, or lines of them")),
      robot_(*app_),
      dec_(flag(*app_, "--dec", "DATA are decimal numbers, one a byte: 90 45 0")),
      from_(option(*app_, "--from", from_text_, "ADDRESS",
                   "Who sends, SUBNET.NODE or a place (default 0.10)")),
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

SendOptions SendWords::parse_options(const Robot* robot) const {
  constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
  SendOptions options;
  if (from_->count() > 0) {
    options.source = parse_sender(robot, from_text_, "--from: ");
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
  auto robot = robot_.find();
  SendOptions options = parse_options(robot.get());
  const MessageWords words = sort_words(robot.get(), {bus_, destination_, data_});
  options.robot = std::move(robot);
  if (words.bus.empty()) {
    refuse("send", "expected BUS, DEST and DATA");
  }
  if (words.destination.empty()) {
    refuse("send", "expected DEST after BUS: a place, SUBNET.NODE, SUBNET.*, ID#DATA or -");
  }
  options.bus = parse_bus(words.bus);
  if (options.wait && parse_bus_url(words.bus)->kind != BusUrl::Kind::local) {
    throw UsageError("--wait: expected with local:NAME alone; on " + words.bus +
                     " nobody can tell who listens");
  }
  if (words.destination == "-") {
    refuse_with(words, "DEST -", "each line of the input", true);
    return options;
  }
  if (interval_->count() > 0 && count_->count() == 0) {
    throw UsageError("--interval: expected with --count N (0: until interrupted)");
  }
  options.frame = is_frame(words.destination) ? parse_frame(words) : parse_message(words, options);
  return options;
}

// Which options make no sense with what says everything itself.
void SendWords::refuse_with(const MessageWords& said, const char* what, const char* who,
                            bool count_too) const {
  std::vector<const CLI::Option*> options{dec_, urgent_, message_class_};
  options.push_back(count_too ? count_ : from_);
  for (const CLI::Option* option : options) {
    if (option->count() > 0) {
      throw UsageError(option->get_name() + ": expected without " + what + ", as " + who +
                       " says its own");
    }
  }
  if (!said.data.empty()) {
    throw UsageError(std::string("DATA: expected none after ") + what + ", as " + who +
                     " has its own");
  }
}

Frame SendWords::parse_frame(const MessageWords& said) const {
  const Frame frame = value_or_refuse(parse_frame_text(said.destination));
  if (frame.kind == FrameKind::error) {
    throw UsageError("frame " + quote(said.destination) +
                     ": a controller's error report; expected a frame to send");
  }
  refuse_with(said, "ID#DATA", "the frame", false);
  return frame;
}

Frame SendWords::parse_message(const MessageWords& said, const SendOptions& options) const {
  Message message{};
  message.header.destination = parse_destination(options.robot.get(), said.destination);
  message.header.source = options.source;
  message.header.priority = urgent_->count() > 0 ? Priority::urgent : Priority::normal;
  message.header.message_class = parse_sendable_class(class_text_);
  const Bytes bytes = parse_data(options.robot.get(), message.header, said.data, dec_->count() > 0);
  message.length = bytes.length;
  std::copy(bytes.data.begin(), bytes.data.end(), message.data);
  Frame frame{};
  if (to_frame(message, frame) != Status::ok) {
    throw UsageError("not a message that can be sent");  // the options allow none such
  }
  return frame;
}

}  // namespace roio::cli
