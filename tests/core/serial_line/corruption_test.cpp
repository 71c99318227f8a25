// Millions of records through a line that damages every second one: whatever arrives is one that
// was sent, in order and once; the first that is whole after a delimiter arrives; and what did not
// arrive is counted, to the frame. Then the same with a CRC-16 in place of the check, which is not
// enough.
//
// A record that is damaged passes the check by chance once in 4.3 billion: of a thousand runs of
// the longest, one may fail.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <deque>
#include <iomanip>
#include <iostream>
#include <roio/serial_record.hpp>
#include <vector>

#include "line.hpp"
#include "sanitizers.hpp"
#include "seed.hpp"
#include "sender.hpp"

namespace roio::test {
namespace {

using serial::RecordReader;
using Bytes = std::vector<std::uint8_t>;
using Event = RecordReader::Event;

/// scripts/soak asks for more.
std::uint64_t record_count() {
  const char* const given = std::getenv("ROIO_SOAK_RECORDS");
  constexpr std::uint64_t usual = is_instrumented ? 1'000'000 : 3'000'000;
  return given != nullptr ? std::strtoull(given, nullptr, 10) : usual;
}

// --- codes ---------------------------------------------------------------------------------------

/// The protocol's own.
class Checked {
 public:
  explicit Checked(std::uint32_t session) : session_(session) {}

  void prepare(RecordReader& reader) const { reader.expect(session_); }

  void encode(const Body& body, Bytes& record) const {
    struct Sink {
      void put(std::uint8_t offset, std::uint8_t byte) { bytes[offset] = byte; }
      std::uint8_t* bytes;
    };
    record.resize(serial::max_record);
    record.resize(
        serial::write_record(Sink{record.data()}, session_, body.bytes.data(), body.length));
  }

  bool decode(const RecordReader& reader, Body& body) const {
    if (!reader.is_intact(session_)) {
      return false;
    }
    body.length = reader.length();
    std::copy_n(reader.body(), body.length, body.bytes.begin());
    return true;
  }

 private:
  std::uint32_t session_;
};

/// As if the check were CRC-16/CCITT, that of HDLC: in the same COBS, which RecordReader takes
/// apart (bodies of 2 and 3 bytes are too short for it then).
class CheckedBy16 {
 public:
  explicit CheckedBy16(std::uint32_t session) : start_(static_cast<std::uint16_t>(~session)) {}

  static void prepare(RecordReader& /*reader*/) {}

  void encode(const Body& body, Bytes& record) const {
    const std::uint16_t check = check_of(body.bytes.data(), body.length);
    record.assign(1, 0);
    std::size_t zero = 0;
    const auto append = [&](std::uint8_t byte) {
      record.push_back(byte);
      if (byte == 0) {
        record[zero] = static_cast<std::uint8_t>(record.size() - 1 - zero);
        zero = record.size() - 1;
      }
    };
    std::for_each_n(body.bytes.begin(), body.length, append);
    append(static_cast<std::uint8_t>(check));
    append(static_cast<std::uint8_t>(check >> 8));
    append(serial::delimiter);
  }

  bool decode(const RecordReader& reader, Body& body) const {
    const auto length =
        static_cast<std::uint8_t>(reader.length() + serial::check_length - sizeof start_);
    const std::uint8_t* const bytes = reader.body();
    if (length > serial::max_body) {
      return false;
    }
    const std::uint16_t check = check_of(bytes, length);
    if (bytes[length] != (check & 0xFF) || bytes[length + 1] != check >> 8) {
      return false;
    }
    body.length = length;
    std::copy_n(bytes, length, body.bytes.begin());
    return true;
  }

 private:
  [[nodiscard]] std::uint16_t check_of(const std::uint8_t* bytes, std::uint8_t length) const {
    std::uint32_t value = start_;
    for (std::uint8_t i = 0; i < length; ++i) {
      value ^= bytes[i];
      for (int bit = 0; bit < 8; ++bit) {
        value = (value >> 1) ^ ((value & 1) != 0 ? 0x8408U : 0U);
      }
    }
    return static_cast<std::uint16_t>(~value);
  }

  std::uint16_t start_;
};

// --- counting ------------------------------------------------------------------------------------

/// Counts frames as docs/internals/serial-protocol.md "Up" has it.
class Count {
 public:
  void take(const Body& body) {
    const std::uint8_t sequence = body.bytes[body.is_control() ? 1 : serial::sequence_at];
    skip(static_cast<std::uint8_t>(sequence - next_));
    if (!body.is_control()) {
      ++delivered_;
      ++next_;
    } else if (body.is(serial::Up::status)) {
      const std::uint32_t unseen = serial::get32(&body.bytes[serial::control_head + 4]) - next_;
      by_due_ += unseen;
      skip(unseen);
    }
  }

  [[nodiscard]] std::uint64_t delivered() const { return delivered_; }
  [[nodiscard]] std::uint64_t lost() const { return lost_; }
  /// Of the lost, those that the sequence did not show.
  [[nodiscard]] std::uint64_t by_due() const { return by_due_; }

 private:
  void skip(std::uint32_t frames) {
    next_ += frames;
    lost_ += frames;
  }

  std::uint32_t next_ = 0;
  std::uint64_t delivered_ = 0;
  std::uint64_t lost_ = 0;
  std::uint64_t by_due_ = 0;
};

// --- the proof -----------------------------------------------------------------------------------

template <typename Code>
class Proof {
 public:
  Proof(Mix mix, std::mt19937 random)
      : random_(random),
        code_(static_cast<std::uint32_t>(random_())),
        line_(mix, random_),
        sender_(random_) {
    code_.prepare(reader_);
  }

  void run(std::uint64_t records) {
    for (records_ = 0; records_ < records; ++records_) {
      send(sender_.next());
    }
    line_.calm_down();
    send(sender_.status());  // may be cut at its beginning
    send(sender_.status());
  }

  [[nodiscard]] std::uint64_t wrong() const { return wrong_; }
  [[nodiscard]] std::uint64_t hit() const { return hit_; }
  /// By the check; COBS was whole.
  [[nodiscard]] std::uint64_t refused() const { return refused_; }
  [[nodiscard]] std::uint64_t missed() const { return missed_; }
  [[nodiscard]] std::uint64_t miscounted() const { return miscounted_; }
  [[nodiscard]] const Count& count() const { return count_; }
  [[nodiscard]] std::uint64_t due() const { return sender_.due(); }

  void print() const {
    std::cout << records_ << " records, " << hit_ << " hit (" << std::setprecision(3)
              << 100.0 * static_cast<double>(hit_) / static_cast<double>(records_) << " %), "
              << broken_ << " broken, " << refused_ << " refused by the check, " << arrived_
              << " arrived, " << wrong_ << " wrong; " << sender_.due() << " frames due, "
              << count_.delivered() << " delivered, " << count_.lost() << " lost, of which "
              << count_.by_due() << " told by due only; faults:";
    for (const std::uint64_t faults : line_.faults()) {
      std::cout << ' ' << faults;
    }
    std::cout << '\n';
  }

 private:
  void send(const Sent& sent) {
    pending_.push_back(sent);
    code_.encode(sent.body, record_);
    const bool in_step = line_.is_in_step();
    bytes_.clear();
    const bool whole = line_.carry(record_, bytes_);
    hit_ += whole ? 0U : 1U;
    last_ = Body{};
    for (const std::uint8_t byte : bytes_) {
      take(byte);
    }
    if (whole && in_step && !(last_ == sent.body)) {
      ++missed_;
    }
  }

  void take(std::uint8_t byte) {
    const Event event = reader_.take(byte);
    if (event == Event::damaged) {
      ++broken_;
    } else if (event == Event::record && !code_.decode(reader_, last_)) {
      ++refused_;
    } else if (event == Event::record) {
      arrive(last_);
    }
  }

  /// It must be one of those sent after the one that arrived before it.
  void arrive(const Body& body) {
    const auto found = std::find_if(pending_.begin(), pending_.end(),
                                    [&](const Sent& sent) { return sent.body == body; });
    Frame frame{};
    if (found == pending_.end() ||
        (!body.is_control() &&
         !serial::read_frame(body.bytes.data(), body.length, serial::frame_head_up, frame))) {
      ++wrong_;
      return;
    }
    ++arrived_;
    count_.take(body);
    check_count(*found);
    pending_.erase(pending_.begin(), found + 1);
  }

  /// What is lost and not counted yet is a multiple of 256, and nothing once due has told.
  void check_count(const Sent& sent) {
    const std::uint64_t due = sent.frames_before + (sent.body.is_control() ? 0U : 1U);
    const std::uint64_t uncounted = due - (count_.delivered() + count_.lost());
    const bool told = sent.body.is(serial::Up::status);
    miscounted_ += uncounted > due || uncounted % 256 != 0 || (told && uncounted != 0) ? 1U : 0U;
  }

  std::mt19937 random_;
  Code code_;
  Line line_;
  Sender sender_;
  RecordReader reader_;
  Count count_;
  std::deque<Sent> pending_;
  Bytes record_;
  Bytes bytes_;
  Body last_;  // that arrived
  std::uint64_t records_ = 0;
  std::uint64_t hit_ = 0;
  std::uint64_t broken_ = 0;
  std::uint64_t refused_ = 0;
  std::uint64_t arrived_ = 0;
  std::uint64_t wrong_ = 0;
  std::uint64_t missed_ = 0;
  std::uint64_t miscounted_ = 0;
};

TEST(Corruption, NoWrongFrameAndEveryLossCounted) {
  Proof<Checked> proof(Mix::everything, seeded_generator());
  proof.run(record_count());
  proof.print();
  EXPECT_EQ(proof.wrong(), 0U) << "arrived, and not sent after what arrived before";
  EXPECT_EQ(proof.missed(), 0U) << "whole after a whole delimiter, and did not arrive";
  EXPECT_EQ(proof.miscounted(), 0U);
  EXPECT_EQ(proof.count().delivered() + proof.count().lost(), proof.due());
  EXPECT_GT(proof.count().by_due(), 0U) << "no outage: nothing for due to tell";
  EXPECT_GT(proof.hit(), record_count() * 2 / 5);
  EXPECT_LT(proof.hit(), record_count() * 3 / 5);
}

TEST(Corruption, ACheckOf16BitsIsNotEnough) {
  const std::mt19937 random = seeded_generator();
  Proof<Checked> proof(Mix::noise, random);
  proof.run(record_count() / 2);
  proof.print();
  EXPECT_EQ(proof.wrong(), 0U);
  EXPECT_EQ(proof.missed(), 0U);
  // With one seed for all: few records that are wrong may be none by chance.
  Proof<CheckedBy16> by_16(Mix::noise, std::mt19937(16));
  by_16.run(record_count());
  by_16.print();
  EXPECT_GT(by_16.wrong(), by_16.refused() / 65'536 / 16) << "far from one in 65,536";
}

}  // namespace
}  // namespace roio::test
