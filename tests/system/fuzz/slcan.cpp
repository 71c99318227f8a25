#include <roio/slcan.hpp>

#include <array>
#include <string>

#include "target.hpp"

namespace roio::fuzz {
namespace {

using Event = slcan::LineReader::Event;
using Kind = slcan::Command::Kind;

bool is_printed(char character) {
  return character > ' ' && character <= '~';
}

char in_capitals(char character) {
  return character >= 'a' && character <= 'f' ? static_cast<char>(character - 'a' + 'A')
                                              : character;
}

/// As format_frame() writes it: digits in capitals, and SavvyCAN's bit 31 gone.
std::string in_order(std::string_view text) {
  std::string ordered(text);
  for (std::size_t i = 1; i < ordered.size(); ++i) {
    ordered[i] = in_capitals(ordered[i]);
  }
  const bool extended = text[0] == 'T' || text[0] == 'R';
  if (extended && (ordered[1] == '8' || ordered[1] == '9')) {
    ordered[1] = static_cast<char>(ordered[1] - '8' + '0');
  }
  return ordered + slcan::ok;
}

void check_command(std::string_view text) {
  const slcan::Command command = slcan::parse(text.data(), static_cast<std::uint8_t>(text.size()));
  require(command.kind == Kind::bitrate || command.bitrate_bps == 0, "a rate is one of a bitrate");
  require((command.kind == Kind::bitrate) == (text.starts_with('S') || text.starts_with('s')),
          "who asks for a rate gets one or none");
  require((command.kind == Kind::empty) == text.empty(), "nothing is what is empty");
  if (command.kind != Kind::frame) {
    return;
  }
  require(is_valid(command.frame) && command.frame.kind != FrameKind::error,
          "a frame read is one that a bus carries");
  std::array<char, slcan::max_line> line{};
  const std::uint8_t length = slcan::format_frame(command.frame, line.data());
  require(std::string(line.data(), length) == in_order(text), "a frame comes back");
}

/// What a reader is to say at the CR after `line`.
Event expected(std::string_view& line) {
  const std::size_t zero = line.rfind('\0');
  line.remove_prefix(zero == std::string_view::npos ? 0 : zero + 1);
  while (line.starts_with('\n')) {
    line.remove_prefix(1);
  }
  return !line.empty() && !is_printed(line[0]) ? Event::noise
         : line.size() > slcan::max_command    ? Event::bad
                                               : Event::line;
}

}  // namespace

void check(std::string_view input) {
  check_command(input.substr(0, 0xFF));
  slcan::LineReader reader;
  std::size_t start = 0;
  for (std::size_t i = 0; i < input.size(); ++i) {
    const Event event = reader.take(static_cast<std::uint8_t>(input[i]));
    require((event != Event::none) == (input[i] == '\r'), "what ends, ends at CR");
    if (input[i] != '\r') {
      continue;
    }
    std::string_view line = input.substr(start, i - start);
    start = i + 1;
    require(event == expected(line), "a line is a line, too long, or noise");
    if (event == Event::line) {
      require(std::string_view(reader.text(), reader.length()) == line, "a line is what was sent");
      check_command(line);
    }
  }
  reader.take(0);
  reader.take('V');
  require(reader.take('\r') == Event::line && reader.length() == 1, "in step again after a zero");
}

}  // namespace roio::fuzz
