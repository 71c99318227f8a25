/// Serial protocol: what the bodies of records between a PC and a bridge say. The one text of it is
/// docs/internals/serial-protocol.md; names and numbers here are those of its tables.
#ifndef ROIO_SERIAL_PROTOCOL_HPP
#define ROIO_SERIAL_PROTOCOL_HPP

#include <stdint.h>

#include <roio/frame.hpp>
#include <roio/serial_record.hpp>

namespace roio {
namespace serial {

constexpr uint8_t protocol_version = 2;
constexpr uint32_t no_session = 0;
constexpr uint8_t window = 16;    ///< Frames down whose outcome is not known yet.
constexpr uint8_t max_rules = 6;  ///< Of FILTER.
constexpr uint8_t max_echo = max_body - 2;
constexpr uint8_t ticks_us = 4;  ///< The unit of the bridge's time.

constexpr uint16_t hello_interval_ms = 50;
constexpr uint16_t poll_interval_ms = 100;
constexpr uint16_t bridge_silence_ms = 500;  ///< After which a PC takes the bridge for lost.
constexpr uint16_t pc_silence_ms = 700;      ///< After which a bridge ends the session.
constexpr uint16_t speed_trial_ms = 300;
constexpr uint16_t results_timeout_ms = 100;  ///< After which frames are sent again.

constexpr uint32_t base_rate_bps = 115200;
constexpr uint8_t rate_count = 5;
constexpr uint32_t rate_bps(uint8_t index) {
  return index == 0   ? base_rate_bps
         : index == 1 ? UINT32_C(250000)
         : index == 2 ? UINT32_C(500000)
         : index == 3 ? UINT32_C(1000000)
                      : UINT32_C(2000000);
}

// --- control records -----------------------------------------------------------------------------

constexpr uint8_t control_bits = 0xE0;

enum class Down : uint8_t {
  hello = control_bits | 0x01,
  poll = control_bits | 0x02,
  bus = control_bits | 0x03,
  filter = control_bits | 0x04,
  address = control_bits | 0x05,
  identify = control_bits | 0x06,
  speed = control_bits | 0x07,
  echo = control_bits | 0x08,
  bye = control_bits | 0x09,
};

enum class Up : uint8_t {
  welcome = control_bits | 0x11,
  status = control_bits | 0x12,
  counters = control_bits | 0x13,
  results = control_bits | 0x14,
  reply = control_bits | 0x15,
  echoed = control_bits | 0x16,
};

constexpr bool is_control(uint8_t first) {
  return (first & control_bits) == control_bits;
}
/// HELLO and WELCOME belong to no session yet.
constexpr uint32_t session_of(uint8_t first, uint32_t session) {
  return first == static_cast<uint8_t>(Down::hello) || first == static_cast<uint8_t>(Up::welcome)
             ? no_session
             : session;
}

enum class Board : uint8_t { other = 0, uno = 1, leonardo = 2, mega = 3 };
enum class Mode : uint8_t { normal = 0, listen_only = 1, loopback = 2 };
enum class State : uint8_t { active, warning, passive, bus_off, no_chip, stuck };
enum class Outcome : uint8_t { pending = 0, sent = 1, not_sent = 2, unknown = 3 };

constexpr uint8_t rate_matters = 0x01;        ///< In WELCOME's flags.
constexpr uint8_t interrupt_is_wired = 0x02;  ///< In WELCOME's flags.
constexpr uint8_t again = 0x01;               ///< In RESULTS' flags.

// Lengths of bodies, the operation and the sequence among them.
constexpr uint8_t control_head = 2;
constexpr uint8_t hello_length = control_head + 5;
constexpr uint8_t welcome_length = control_head + 29;
constexpr uint8_t status_length = control_head + 11;
constexpr uint8_t counter_count = 11;
constexpr uint8_t counters_at_once = 4;
constexpr uint8_t counters_length = control_head + 1 + 4 * counters_at_once;  ///< At most.
constexpr uint8_t results_length = control_head + 6;
constexpr uint8_t reply_length = control_head + 2;

// --- numbers -------------------------------------------------------------------------------------

inline uint16_t get16(const uint8_t* bytes) {
  return static_cast<uint16_t>(static_cast<uint16_t>(bytes[0] << 8) | bytes[1]);
}
inline uint32_t get32(const uint8_t* bytes) {
  return (static_cast<uint32_t>(get16(bytes)) << 16) | get16(bytes + 2);
}

// --- life ----------------------------------------------------------------------------------------

//  7..4   3..0
//  shift  base     base << shift: for so long a frame may wait from when the bridge takes it
constexpr uint8_t life_forever = 0xFF;
constexpr uint16_t life_unit_us = 256 * ticks_us;
constexpr uint8_t longest_life = 0xBF;  ///< 31 s; what a bridge's clock tells from the past.

/// @param life at most longest_life. @return in units of life_unit_us: 0..30720.
constexpr uint16_t life_units(uint8_t life) {
  return static_cast<uint16_t>((life & 0x0FU) << (life >> 4));
}
/// The longest that is not longer than so many units: less than a ninth shorter.
inline uint8_t life_of_units(uint32_t units) {
  uint8_t shift = 0;
  for (; units > 0x0FU; units >>= 1) {
    ++shift;
  }
  const uint8_t life = static_cast<uint8_t>((static_cast<unsigned>(shift) << 4) | units);
  return shift > longest_life >> 4 ? longest_life : life;
}

// --- frames --------------------------------------------------------------------------------------

constexpr uint8_t frame_head_down = 6;  ///< Tag, sequence and life.
constexpr uint8_t frame_head_up = 7;    ///< Tag, sequence and time.
constexpr uint8_t sequence_at = 4;
constexpr uint8_t life_at = 5;
constexpr uint8_t time_at = 5;

/// What comes after the head: a remote frame has a length in place of data.
template <typename Writer>
void put_payload(Writer& writer, FrameKind kind, uint8_t length, const uint8_t* data) {
  if (is_remote(kind)) {
    writer.put(length);
    return;
  }
  for (uint8_t i = 0; i < length; ++i) {
    writer.put(data[i]);
  }
}

/// @param frame is_valid(), and no error report.
template <typename Writer>
void put_frame_down(Writer& writer, const Frame& frame, uint8_t sequence, uint8_t life) {
  writer.put32(tagged_id(frame));
  writer.put(sequence);
  writer.put(life);
  put_payload(writer, frame.kind, frame.length, frame.data);
}

/// Reads the body of a frame's record.
/// @param head frame_head_down or frame_head_up.
/// @param frame written whole on true only.
/// @return whether it is one that a bus carries.
inline bool read_frame(const uint8_t* body, uint8_t length, uint8_t head, Frame& frame) {
  if (length < head) {
    return false;
  }
  Frame read;
  const uint32_t tag = get32(body);
  read.kind = static_cast<FrameKind>(tag >> 29);
  read.id = tag & UINT32_C(0x1FFFFFFF);
  const bool remote = is_remote(read.kind);
  const uint8_t payload = static_cast<uint8_t>(length - head);
  read.length = remote && payload == 1 ? body[head] : payload;
  if ((remote && payload != 1) || !is_valid(read) || read.kind == FrameKind::error) {
    return false;
  }
  for (uint8_t i = 0; i < max_data_length; ++i) {
    read.data[i] = !remote && i < payload ? body[head + i] : uint8_t{0};
  }
  frame = read;
  return true;
}

}  // namespace serial
}  // namespace roio

#endif
