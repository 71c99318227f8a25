#include "ask/words.hpp"

#include <algorithm>
#include <roio/text.hpp>

#include "program/words.hpp"
#include "send/message_words.hpp"

namespace roio::cli {
namespace {

constexpr const char* examples = R"(Examples:
  roio-cli ask can0 0.2 01                     1 when no answer comes in time
  roio-cli ask --timeout 200 can0 0.2 01
  roio-cli ask can0 0.2 --dec 90 45 0
  roio-cli ask can0 '0.*' 01                   the first of subnet 0 to answer

It prints the first message from DEST to our own address (--from) that is on the
bus after the question, as dump does. An answer that comes too late is nobody's,
unless the next question is asked just then.)";

}  // namespace

AskWords::AskWords(CLI::App& program)
    : app_(program.add_subcommand("ask", "Send a message, and print the answer")),
      robot_(*app_),
      dec_(flag(*app_, "--dec", "DATA are decimal numbers, one a byte: 90 45 0")),
      urgent_(flag(*app_, "--urgent", "Ahead of normal messages")),
      json_(flag(*app_, "--json", "The answer as a JSON line")) {
  prepare(*app_, "ask [OPTIONS] [BUS] DEST [DATA...]", examples);
  without_type(app_->add_option("BUS", bus_, "can0, local:NAME or serial:DEVICE"));
  without_type(app_->add_option("DEST", destination_, "SUBNET.NODE, or SUBNET.* (anybody there)"));
  without_type(app_->add_option("DATA", data_, "1 to 8 bytes in hexadecimal: 5A2D00"));
  option(*app_, "--from", from_text_, "ADDRESS", "Own address, answers go to (default 0.10)");
  option(*app_, "--class", class_text_, "NAME", "message (default), system or stream");
  option(*app_, "--timeout", timeout_text_, "MS", "Longest wait for the answer (default 1000)");
}

AskOptions AskWords::parse() const {
  refuse_rest(*app_, "ask");
  AskOptions options;
  Header& header = options.message.header;
  // First the options, as elsewhere.
  options.robot = robot_.find();
  const Robot* const robot = options.robot.get();
  header.source = parse_sender(robot, from_text_, "--from: ");
  header.message_class = parse_sendable_class(class_text_);
  header.priority = urgent_->count() > 0 ? Priority::urgent : Priority::normal;
  options.timeout = parse_ms("--timeout", timeout_text_, 1);
  options.json = json_->count() > 0;
  const MessageWords words = sort_words(robot, {bus_, destination_, data_});
  if (words.bus.empty()) {
    refuse("ask", "expected BUS, DEST and DATA");
  }
  if (words.destination.empty()) {
    refuse("ask", "expected DEST after BUS: a place, SUBNET.NODE or SUBNET.*");
  }
  options.bus = parse_bus(words.bus);
  header.destination = parse_destination(robot, words.destination);
  const Bytes bytes = parse_data(robot, header, words.data, dec_->count() > 0);
  options.message.length = bytes.length;
  std::copy(bytes.data.begin(), bytes.data.end(), options.message.data);
  return options;
}

}  // namespace roio::cli
