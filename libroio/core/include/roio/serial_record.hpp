/// Serial records: how bytes become records that cannot be mistaken for others, and back. The same
/// code runs on the bridge and on the PC. What is in them is serial_protocol.hpp's.
///
///   record = COBS( body, CRC-32C ) 0x00      body 2..56 bytes
///
/// No heap, no state but what is shown; bounded by the length of a record.
/// Source: docs/internals/serial-protocol.md "Records".
#ifndef ROIO_SERIAL_RECORD_HPP
#define ROIO_SERIAL_RECORD_HPP

#include <stdint.h>

#include <roio/crc32c.hpp>

namespace roio {
namespace serial {

constexpr uint8_t check_length = 4;
constexpr uint8_t min_body = 2;
constexpr uint8_t max_body = 56;
/// On the line: a byte of COBS, body, check, delimiter.
constexpr uint8_t max_record = 1 + max_body + check_length + 1;
constexpr uint8_t delimiter = 0;

/// The body of a record, as it is put together: max_body bytes at most.
class Body {
 public:
  Body() : length_(0) {}  // the bytes are nobody's before they are put

  void put(uint8_t byte) { bytes_[length_++] = byte; }
  void put16(uint16_t value) {
    put(static_cast<uint8_t>(value >> 8));
    put(static_cast<uint8_t>(value));
  }
  void put32(uint32_t value) {
    put16(static_cast<uint16_t>(value >> 16));
    put16(static_cast<uint16_t>(value));
  }
  const uint8_t* bytes() const { return bytes_; }
  uint8_t length() const { return length_; }

 private:
  uint8_t length_;
  uint8_t bytes_[max_body];
};

/// Puts a record into a Sink, byte by byte. All of it is inlined, so that what changes with each
/// byte can stay in registers; best with a Sink that is a small value.
///
///   struct Sink { void put(uint8_t offset, uint8_t byte); };  // in no order; offset < max_record
template <typename Sink>
class RecordEncoder {
 public:
  __attribute__((always_inline)) RecordEncoder(Sink sink, uint32_t session)
      : sink_(sink), check_(session), zero_(0), at_(1) {}

  __attribute__((always_inline)) void add(const uint8_t* bytes, uint8_t length) {
    for (; length != 0; --length) {
      const uint8_t byte = *bytes++;
      check_.add(byte);
      place(byte);
    }
  }
  /// @return how many bytes the record has.
  __attribute__((always_inline)) uint8_t finish() {
    for (uint8_t i = 0; i < check_length; ++i) {
      place(check_.take_byte());
    }
    end_block();
    sink_.put(at_, delimiter);
    return static_cast<uint8_t>(at_ + 1U);
  }

 private:
  __attribute__((always_inline)) void place(uint8_t byte) {
    if (byte != 0) {
      sink_.put(at_, byte);
    } else {
      end_block();
    }
    ++at_;
  }
  /// A zero is known by its distance to the next one; the last is the delimiter.
  __attribute__((always_inline)) void end_block() {
    sink_.put(zero_, static_cast<uint8_t>(at_ - zero_));
    zero_ = at_;
  }

  Sink sink_;
  Crc32c check_;
  uint8_t zero_;
  uint8_t at_;
};

/// Writes the record of a body that lies in two pieces.
/// @param length, more_length of the pieces: min_body..max_body together.
/// @return how many bytes the record has.
template <typename Sink>
__attribute__((always_inline)) inline uint8_t write_record(Sink sink, uint32_t session,
                                                           const uint8_t* body, uint8_t length,
                                                           const uint8_t* more = nullptr,
                                                           uint8_t more_length = 0) {
  RecordEncoder<Sink> encoder(sink, session);
  encoder.add(body, length);
  encoder.add(more, more_length);
  return encoder.finish();
}

/// A body that becomes a record where it ends: for who has time.
///
///   RecordWriter<Sink> writer(sink, session);
///   writer.put(...);
///   const uint8_t length = writer.finish();
template <typename Sink>
class RecordWriter : public Body {
 public:
  RecordWriter(Sink& sink, uint32_t session) : sink_(sink), session_(session) {}

  /// @return how many bytes the record has.
  uint8_t finish() { return write_record<Sink&>(sink_, session_, bytes(), length()); }

 private:
  Sink& sink_;
  uint32_t session_;
};

/// Finds records in a stream of bytes. Checks them as their bytes come, so that little is left to
/// do at the end: for those of one session, which is told beforehand.
///
///   reader.expect(session);
///   if (reader.take(byte) == RecordReader::Event::record && reader.is_intact(session))
///     use(reader.body(), reader.length());
class RecordReader {
 public:
  enum class Event : uint8_t {
    none,     ///< Nothing has ended.
    record,   ///< One has ended that is whole as far as COBS goes; is_intact() says whether it is.
    damaged,  ///< What has ended breaks COBS, or is too short or too long.
  };

  RecordReader()
      : length_(0),
        block_(0),
        state_(State::empty),
        expected_(0),
        checked_(0),
        check_(0),
        buffer_() {}

  /// From the next record on, most are of this session.
  void expect(uint32_t session) { expected_ = session; }

  Event take(uint8_t byte) {
    uint8_t count = 1;
    return take(&byte, count);
  }

  /// Takes bytes up to the end of a record, that one included.
  /// @param count how many there are; becomes how many were taken: all, unless something has ended.
  Event take(const uint8_t* bytes, uint8_t& count) {
    // What changes with each byte is kept out of memory: at 1 Mbit/s one comes every 160 cycles.
    uint8_t length = length_;
    uint8_t block = block_;
    Crc32c check = check_;
    uint8_t left = count;
    uint8_t* next = buffer_ + length;
    Event event = Event::none;
    if (left != 0 && state_ == State::ended) {
      length = 0;
      next = buffer_;
      block = 0;
      state_ = State::empty;
    }
    while (left != 0) {
      uint8_t byte = *bytes++;
      --left;
      if (byte == delimiter) {
        if (state_ == State::empty) {
          continue;
        }
        event = end(length, block);
        break;
      }
      // A block's first byte says how far its zero is; the first of all has none before it.
      if (block != 0) {
        --block;
      } else {
        block = static_cast<uint8_t>(byte - 1U);
        byte = 0;
        if (state_ == State::empty) {
          state_ = State::inside;
          checked_ = expected_;
          check = Crc32c(expected_);
          continue;
        }
      }
      if (length == sizeof buffer_) {
        state_ = State::broken;
        length = 0;
        next = buffer_;
      }
      check.add(byte);
      *next++ = byte;
      ++length;
    }
    count = static_cast<uint8_t>(count - left);
    length_ = length;
    block_ = block;
    check_ = check;
    return event;
  }

  /// Of the record that take() has just told of; until the next byte.
  bool is_intact(uint32_t session) const {
    Crc32c check = check_;
    if (session != checked_) {
      check = Crc32c(session);
      for (uint8_t i = 0; i < length_; ++i) {
        check.add(buffer_[i]);
      }
    }
    return check.ends_with_sum();
  }
  const uint8_t* body() const { return buffer_; }
  /// Without the check.
  uint8_t length() const { return static_cast<uint8_t>(length_ - check_length); }

 private:
  enum class State : uint8_t {
    empty,   // nothing since a delimiter
    inside,  // of a record
    broken,  // of something that is too long to be one; the buffer holds nonsense
    ended,   // the buffer is the reader's user's
  };

  /// Something ends, here.
  Event end(uint8_t length, uint8_t block) {
    const bool is_record =
        state_ == State::inside && block == 0 && length >= min_body + check_length;
    state_ = State::ended;
    return is_record ? Event::record : Event::damaged;
  }

  uint8_t length_;
  uint8_t block_;  // bytes to come before the next code
  State state_;
  uint32_t expected_;
  uint32_t checked_;  // the session that check_ is for
  Crc32c check_;      // of all that is in the buffer
  uint8_t buffer_[max_body + check_length];
};

}  // namespace serial
}  // namespace roio

#endif
