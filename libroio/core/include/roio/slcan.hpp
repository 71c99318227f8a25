/// SLCAN: the ASCII protocol of LAWICEL's CAN232 and CANUSB adapters, which slcand, python-can and
/// SavvyCAN speak: commands out of bytes, and frames and answers as text. Nothing here knows what
/// is open; who uses it answers `ok` or `error`, see Command.
///
/// It has no check: a byte that the line damages can make another frame, as none can of a record
/// (serial_record.hpp). No heap; a LineReader is 28 bytes.
/// Source: the manuals of CAN232 (version 3) and CANUSB; Linux, drivers/net/can/slcan.
#ifndef ROIO_SLCAN_HPP
#define ROIO_SLCAN_HPP

#include <stdint.h>

#include <roio/bit_timing.hpp>
#include <roio/frame.hpp>

namespace roio {
namespace slcan {

constexpr char ok = '\r';  ///< Ends each line; alone it is the answer to a command that was done.
constexpr char error = '\a';  ///< The answer to one that was not. No CR comes after it.

/// T, 8 digits of identifier, length, 16 digits of data; without the CR.
constexpr uint8_t max_command = 1 + 8 + 1 + 16;
/// The longest text that a format_ function writes: such a frame, 4 digits of time, CR.
constexpr uint8_t max_line = max_command + 4 + 1;
/// Times of frames, in milliseconds, are below it.
constexpr uint16_t time_span_ms = 60000;

// What F answers, as far as an MCP2515 knows it.
constexpr uint8_t receive_full = 0x01;
constexpr uint8_t transmit_full = 0x02;
constexpr uint8_t error_warning = 0x04;
constexpr uint8_t overrun = 0x08;
constexpr uint8_t error_passive = 0x20;
constexpr uint8_t bus_error = 0x80;

/// Finds lines in a stream of bytes.
///
///   if (reader.take(byte) == LineReader::Event::line)
///     const Command command = parse(reader.text(), reader.length());
///
/// A line ends at CR. LF before one is passed over, so that CR LF ends a line too. A zero, which
/// ends a serial record, starts over.
class LineReader {
 public:
  enum class Event : uint8_t {
    none,   ///< Nothing has ended.
    line,   ///< text() and length() are its own, until the next byte. An empty one counts.
    bad,    ///< What has ended is longer than any command; answer `error`.
    noise,  ///< What has ended began with no printable character: a piece of a record. No answer.
  };

  LineReader() : length_(0), state_(State::inside), text_() {}

  Event take(uint8_t byte) {
    if (state_ == State::ended) {
      reset();
    }
    if (byte == 0) {
      reset();
    } else if (byte == '\r') {
      return end();
    } else if (state_ == State::inside) {
      append(byte);
    }
    return Event::none;
  }

  void reset() {
    length_ = 0;
    state_ = State::inside;
  }

  const char* text() const { return text_; }
  uint8_t length() const { return length_; }

 private:
  enum class State : uint8_t { inside, too_long, noise, ended };

  void append(uint8_t byte) {
    if (length_ == 0 && (byte <= ' ' || byte > '~')) {
      state_ = byte == '\n' ? State::inside : State::noise;
    } else if (length_ == sizeof text_) {
      state_ = State::too_long;
    } else {
      text_[length_++] = static_cast<char>(byte);
    }
  }

  Event end() {
    const State state = state_;
    state_ = State::ended;
    return state == State::inside ? Event::line : state == State::noise ? Event::noise : Event::bad;
  }

  uint8_t length_;
  State state_;
  char text_[max_command];
};

/// What a line asks for.
struct Command {
  enum class Kind : uint8_t {
    bad,            ///< No command, or not in full, or one that this adapter has not: `error`.
    empty,          ///< Nothing but CR, which a program sends to be rid of half a command: `ok`.
    open,           ///< O
    listen,         ///< L: open, listen only.
    close,          ///< C
    bitrate,        ///< S0..S9, s: bitrate_bps, or none: `error`, and nothing opens before another
                    ///< is accepted. Only while closed.
    frame,          ///< t, T, r, R: frame. Only while open, and not in listen only. taken(), `ok`.
    flags,          ///< F: format_flags().
    version,        ///< V: format_about().
    serial_number,  ///< N: format_about().
    times_off,      ///< Z0. Only while closed.
    times_on,       ///< Z1. Only while closed.
    no_change,      ///< X1, M00000000, mFFFFFFFF: frames unasked, all of them, as always: `ok`.
  };
  Kind kind;
  uint32_t bitrate_bps;            ///< Of a bitrate; 0: there is no such.
  uint16_t sample_point_permille;  ///< Of a bitrate.
  Frame frame;                     ///< Of a frame: is_valid(), and no error report.
};

/// The first character of the answer to a frame that was taken; `ok` is the second and last.
constexpr char taken(FrameKind kind) {
  return is_extended(kind) ? 'Z' : 'z';
}

namespace detail {

constexpr char lower_case = 'a' - 'A';  // the bit of a letter

/// @return 0..15, or more if it is no digit.
inline uint8_t hex_value(char digit) {
  const uint8_t decimal = static_cast<uint8_t>(digit - '0');
  const uint8_t letter = static_cast<uint8_t>((digit | lower_case) - 'a');
  return decimal < 10 ? decimal : letter < 6 ? static_cast<uint8_t>(letter + 10) : uint8_t{0xFF};
}

inline bool are_digits(const char* text, uint8_t count) {
  for (uint8_t i = 0; i < count; ++i) {
    if (hex_value(text[i]) > 15) {
      return false;
    }
  }
  return true;
}

/// @param text of which are_digits() is true; 8 of them at most.
inline uint32_t number(const char* text, uint8_t digits) {
  uint32_t value = 0;
  for (uint8_t i = 0; i < digits; ++i) {
    value = (value << 4) | hex_value(text[i]);
  }
  return value;
}

/// M and m are those of an SJA1000, which can be asked for what an MCP2515 cannot do.
/// @param text a letter and 8 digits.
inline bool lets_all_pass(const char* text) {
  const uint32_t bits = number(text + 1, 8);
  return text[0] == 'M' ? bits == 0 : text[0] == 'm' && bits == UINT32_C(0xFFFFFFFF);
}

constexpr bool is_frame_letter(char letter) {
  return (letter | lower_case) == 't' || (letter | lower_case) == 'r';
}
constexpr FrameKind kind_of(char letter) {
  return static_cast<FrameKind>(((letter & lower_case) != 0 ? 0 : 4) |
                                ((letter | lower_case) == 'r' ? 2 : 0));
}
constexpr char letter_of(FrameKind kind) {
  return static_cast<char>((is_remote(kind) ? 'R' : 'T') | (is_extended(kind) ? 0 : lower_case));
}

//  t iii      l dd..     identifier, length, data; none of a remote frame
//  T iiiiiiii l dd..
/// @param text a letter and digits.
inline bool read_frame(const char* text, uint8_t length, Frame& frame) {
  frame.kind = kind_of(text[0]);
  const uint8_t head = is_extended(frame.kind) ? 1 + 8 + 1 : 1 + 3 + 1;
  if (length < head) {
    return false;
  }
  frame.id = number(text + 1, static_cast<uint8_t>(head - 2));
  if (is_extended(frame.kind)) {
    frame.id &= UINT32_C(0x7FFFFFFF);  // SavvyCAN sends SocketCAN's flag along
  }
  frame.length = hex_value(text[head - 1]);
  const uint8_t bytes = is_remote(frame.kind) ? uint8_t{0} : frame.length;
  if (frame.id > max_id(frame.kind) || frame.length > max_data_length ||
      length != static_cast<uint8_t>(head + 2 * bytes)) {
    return false;
  }
  for (uint8_t i = 0; i < bytes; ++i) {
    text += 2;
    frame.data[i] = static_cast<uint8_t>(number(text + head - 2, 2));
  }
  return true;
}

/// Of S0..S8, in units of 5 kbit/s; 0 of any other digit. No switch here and below: of one, avr-gcc
/// makes a table in RAM.
constexpr uint8_t standard_bitrate(char digit) {
  return digit == '0'   ? 2
         : digit == '1' ? 4
         : digit == '2' ? 10
         : digit == '3' ? 20
         : digit == '4' ? 25
         : digit == '5' ? 50
         : digit == '6' ? 100
         : digit == '7' ? 160
         : digit == '8' ? 200
                        : 0;
}
/// S9 is none of LAWICEL's, but what python-can sends for 83,300 bit/s.
constexpr uint32_t bitrate_of(char digit) {
  return digit == '9' ? UINT32_C(83333) : standard_bitrate(digit) * UINT32_C(5000);
}

//  7..6      5..0        7        6..4       3..0
//  jump - 1  prescaler-1 triple   seg2 - 1   seg1 - 1     BTR0, BTR1 of an SJA1000 at 16 MHz
/// Rate and sample point are what has to agree with the other nodes; how an MCP2515 comes to them
/// is for its own crystal to say.
inline void read_registers(uint8_t btr0, uint8_t btr1, uint32_t& bitrate_bps,
                           uint16_t& sample_point_permille) {
  constexpr uint32_t clock_hz = 8000000;  // half of its crystal's
  const uint16_t before = static_cast<uint16_t>(2U + (btr1 & 0x0FU));
  const uint16_t quanta = static_cast<uint16_t>(before + 1U + ((btr1 >> 4) & 7U));
  const uint16_t prescaler = static_cast<uint16_t>((btr0 & 0x3FU) + 1U);
  bitrate_bps = clock_hz / (prescaler * quanta);
  sample_point_permille = static_cast<uint16_t>(before * 1000U / quanta);
}

/// Of a command that is one letter.
constexpr Command::Kind letter_kind(char letter) {
  return letter == 'O'   ? Command::Kind::open
         : letter == 'L' ? Command::Kind::listen
         : letter == 'C' ? Command::Kind::close
         : letter == 'F' ? Command::Kind::flags
         : letter == 'V' ? Command::Kind::version
         : letter == 'N' ? Command::Kind::serial_number
                         : Command::Kind::bad;
}

/// Of one that is a letter and a digit.
constexpr Command::Kind setting_kind(char letter, char digit) {
  return letter == 'Z' && digit == '0'   ? Command::Kind::times_off
         : letter == 'Z' && digit == '1' ? Command::Kind::times_on
         : letter == 'X' && digit == '1' ? Command::Kind::no_change
                                         : Command::Kind::bad;
}

}  // namespace detail

namespace detail {

/// S or s, whatever comes after it: a rate that was asked for and is none is told from no command.
/// @param text of which are_digits() is true from the second on.
inline void read_bitrate(const char* text, uint8_t length, Command& command) {
  command.kind = Command::Kind::bitrate;
  if (text[0] == 'S' && length == 1 + 1) {
    command.bitrate_bps = bitrate_of(text[1]);
    command.sample_point_permille = default_sample_point_permille(command.bitrate_bps);
  } else if (text[0] == 's' && length == 1 + 4) {
    read_registers(static_cast<uint8_t>(number(text + 1, 2)),
                   static_cast<uint8_t>(number(text + 3, 2)), command.bitrate_bps,
                   command.sample_point_permille);
  }
}

}  // namespace detail

/// @param text need not end with a zero, and is read no further than `length`.
inline Command parse(const char* text, uint8_t length) {
  Command command = {Command::Kind::bad, 0, 0, {0, FrameKind::standard, 0, {}}};
  const char letter = length == 0 ? '\0' : text[0];
  const bool has_digits =
      length > 1 && detail::are_digits(text + 1, static_cast<uint8_t>(length - 1));
  if (length == 0) {
    command.kind = Command::Kind::empty;
  } else if ((letter | detail::lower_case) == 's') {
    detail::read_bitrate(text, has_digits ? length : uint8_t{1}, command);
  } else if (length == 1) {
    command.kind = detail::letter_kind(letter);
  } else if (!has_digits) {
    command.kind = Command::Kind::bad;
  } else if (detail::is_frame_letter(letter)) {
    if (detail::read_frame(text, length, command.frame)) {
      command.kind = Command::Kind::frame;
    }
  } else if (length == 2) {
    command.kind = detail::setting_kind(letter, text[1]);
  } else if (length == 1 + 8 && detail::lets_all_pass(text)) {
    command.kind = Command::Kind::no_change;
  }
  return command;
}

namespace detail {

// Each writes to `at`, and returns where the next one goes.

/// @param value 0..15.
inline char* put_digit(char* at, uint8_t value) {
  *at = static_cast<char>(value + (value < 10 ? '0' : 'A' - 10));
  return at + 1;
}
inline char* put_byte(char* at, uint8_t value) {
  return put_digit(put_digit(at, static_cast<uint8_t>(value >> 4)), value & 15U);
}

inline char* put_id(char* at, const Frame& frame) {
  if (is_extended(frame.kind)) {
    at = put_byte(at, static_cast<uint8_t>(frame.id >> 24));
    at = put_byte(at, static_cast<uint8_t>(frame.id >> 16));
    at = put_byte(at, static_cast<uint8_t>(frame.id >> 8));
  } else {
    at = put_digit(at, static_cast<uint8_t>(frame.id >> 8));
  }
  return put_byte(at, static_cast<uint8_t>(frame.id));
}

inline char* put_frame(char* at, const Frame& frame) {
  *at++ = letter_of(frame.kind);
  at = put_digit(put_id(at, frame), frame.length);
  const uint8_t bytes = is_remote(frame.kind) ? uint8_t{0} : frame.length;
  for (uint8_t i = 0; i < bytes; ++i) {
    at = put_byte(at, frame.data[i]);
  }
  return at;
}

/// @return how long the line is.
inline uint8_t finish(const char* line, char* at) {
  *at = ok;
  return static_cast<uint8_t>(at + 1 - line);
}

}  // namespace detail

/// Writes a frame as a line, its CR and no zero at its end.
/// @param frame is_valid(), and no error report.
/// @param line room for max_line characters.
/// @return its length.
inline uint8_t format_frame(const Frame& frame, char* line) {
  return detail::finish(line, detail::put_frame(line, frame));
}

/// The same, with the time, for Z1.
/// @param time_ms less than time_span_ms.
inline uint8_t format_frame(const Frame& frame, uint16_t time_ms, char* line) {
  char* at = detail::put_frame(line, frame);
  at = detail::put_byte(at, static_cast<uint8_t>(time_ms >> 8));
  at = detail::put_byte(at, static_cast<uint8_t>(time_ms));
  return detail::finish(line, at);
}

/// The answer to F.
/// @param flags receive_full and so on, added up.
inline uint8_t format_flags(uint8_t flags, char* line) {
  line[0] = 'F';
  return detail::finish(line, detail::put_byte(line + 1, flags));
}

/// The answer to V or N.
/// @param letter which of them.
/// @param text 4 characters: of V two digits of the hardware's version and two of the software's,
/// of N letters or digits.
inline uint8_t format_about(char letter, const char* text, char* line) {
  line[0] = letter;
  for (uint8_t i = 0; i < 4; ++i) {
    line[1 + i] = text[i];
  }
  return detail::finish(line, line + 5);
}

}  // namespace slcan
}  // namespace roio

#endif
