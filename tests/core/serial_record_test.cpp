// Serial records and the protocol's own table of worked bytes.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <random>
#include <roio/serial_protocol.hpp>
#include <roio/serial_record.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "seed.hpp"

namespace roio::serial {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct VectorSink {
  void put(std::uint8_t offset, std::uint8_t byte) { bytes.at(offset) = byte; }
  std::array<std::uint8_t, max_record> bytes{};
};

Bytes encode(const Bytes& body, std::uint32_t session) {
  VectorSink sink;
  RecordWriter<VectorSink> writer(sink, session);
  for (const std::uint8_t byte : body) {
    writer.put(byte);
  }
  const std::uint8_t length = writer.finish();
  return {sink.bytes.begin(), sink.bytes.begin() + length};
}

/// Bodies of the intact records in a stream, and how many others there were.
struct Decoded {
  std::vector<Bytes> bodies;
  int damaged = 0;
};
Decoded decode(const Bytes& stream, std::uint32_t session) {
  Decoded decoded;
  RecordReader reader;
  reader.expect(session);
  RecordReader surprised;
  surprised.expect(~session);
  for (const std::uint8_t byte : stream) {
    const RecordReader::Event event = reader.take(byte);
    EXPECT_EQ(surprised.take(byte), event);
    if (event == RecordReader::Event::none) {
      continue;
    }
    const bool is_intact = event == RecordReader::Event::record && reader.is_intact(session);
    if (event == RecordReader::Event::record) {
      EXPECT_EQ(surprised.is_intact(session), is_intact) << "whatever was expected";
    }
    if (is_intact) {
      decoded.bodies.emplace_back(reader.body(), reader.body() + reader.length());
    } else {
      ++decoded.damaged;
    }
  }
  return decoded;
}

// --- the document's worked bytes -----------------------------------------------------------------

struct Row {
  std::string what;
  std::uint32_t session;
  Bytes body;
  Bytes line;
};

Bytes from_hex(const std::string& text) {
  Bytes bytes;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoul(text.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  std::string cell;
  while (std::getline(stream, cell, '|')) {
    const auto begin = cell.find_first_not_of(' ');
    cells.push_back(begin == std::string::npos
                        ? ""
                        : cell.substr(begin, cell.find_last_not_of(' ') - begin + 1));
  }
  return cells;
}

std::vector<Row> worked_bytes() {
  std::ifstream document(ROIO_SERIAL_PROTOCOL_DOCUMENT);
  std::vector<Row> rows;
  std::string line;
  while (std::getline(document, line) && line != "## Worked bytes") {
  }
  while (std::getline(document, line)) {
    const std::vector<std::string> cells = cells_of(line);
    if (cells.size() == 6 && (cells[2] == "up" || cells[2] == "down")) {
      rows.push_back({cells[1], static_cast<std::uint32_t>(std::stoul(cells[3], nullptr, 16)),
                      from_hex(cells[4]), from_hex(cells[5])});
    }
  }
  return rows;
}

TEST(SerialDocument, WorkedBytesAreWhatIsWrittenAndRead) {
  const std::vector<Row> rows = worked_bytes();
  ASSERT_EQ(rows.size(), 20U);
  for (const Row& row : rows) {
    EXPECT_EQ(encode(row.body, row.session), row.line) << row.what;
    EXPECT_EQ(decode(row.line, row.session).bodies, std::vector<Bytes>{row.body}) << row.what;
  }
}

TEST(SerialDocument, WorkedFramesAreThoseFrames) {
  for (const Row& row : worked_bytes()) {
    if (is_control(row.body.at(0))) {
      continue;
    }
    const bool up = row.what.starts_with("frame") || row.what.starts_with("standard");
    Frame frame{};
    ASSERT_TRUE(read_frame(row.body.data(), static_cast<std::uint8_t>(row.body.size()),
                           up ? frame_head_up : frame_head_down, frame))
        << row.what;
    if (!up) {
      VectorSink sink;
      RecordWriter<VectorSink> writer(sink, row.session);
      put_frame_down(writer, frame, row.body[sequence_at], row.body[life_at]);
      EXPECT_EQ(writer.finish(), row.line.size()) << row.what;
      EXPECT_EQ(Bytes(sink.bytes.begin(), sink.bytes.begin() + row.line.size()), row.line)
          << row.what;
    }
  }
}

// --- records -------------------------------------------------------------------------------------

TEST(Crc32c, HasTheValueThatItsAuthorsGive) {
  Crc32c check;
  for (const char digit : std::string("123456789")) {
    check.add(static_cast<std::uint8_t>(digit));
  }
  EXPECT_EQ(check.value(), 0xE3069283U);
}

TEST(Crc32c, ItsOwnSumEndsItWhateverComesBefore) {
  std::mt19937 random = test::seeded_generator();
  for (int run = 0; run < 2'000; ++run) {
    Crc32c check(static_cast<std::uint32_t>(random()));
    for (std::size_t left = random() % 60; left > 0; --left) {
      check.add(static_cast<std::uint8_t>(random()));
    }
    Crc32c sum = check;
    const std::uint32_t wrong_bit = random() % 32;
    Crc32c wrong = check;
    for (std::uint32_t i = 0; i < 4; ++i) {
      const std::uint8_t byte = sum.take_byte();
      check.add(byte);
      wrong.add(static_cast<std::uint8_t>(byte ^ (wrong_bit / 8 == i ? 1U << wrong_bit % 8 : 0U)));
    }
    ASSERT_TRUE(check.ends_with_sum());
    ASSERT_FALSE(wrong.ends_with_sum());
  }
}

TEST(SerialRecord, AnyBodyComesBack) {
  std::mt19937 random = test::seeded_generator();
  for (int run = 0; run < 20'000; ++run) {
    Bytes body(min_body + random() % (max_body - min_body + 1));
    for (std::uint8_t& byte : body) {
      byte = static_cast<std::uint8_t>(random() % 4 == 0 ? 0 : random());
    }
    const auto session = static_cast<std::uint32_t>(random());
    const Bytes line = encode(body, session);
    ASSERT_EQ(line.size(), body.size() + 6);
    ASSERT_EQ(std::count(line.begin(), line.end(), 0), 1);
    const Decoded decoded = decode(line, session);
    ASSERT_EQ(decoded.bodies, std::vector<Bytes>{body});
    ASSERT_EQ(decode(line, session + 1).bodies.size(), 0U) << "never in another session";
  }
}

TEST(SerialRecord, ASessionThatBeginsInTheMiddleOfARecordDoesNotCheckIt) {
  constexpr std::uint32_t before = 7;
  constexpr std::uint32_t after = 8;
  for (const std::uint32_t session : {before, after}) {
    const Bytes line = encode({0x90, 0x00, 0x40, 0x0A, 0x02, 0x00, 0x2D}, session);
    for (std::size_t at = 0; at <= line.size(); ++at) {
      RecordReader reader;
      reader.expect(before);
      for (std::size_t i = 0; i < line.size(); ++i) {
        if (i == at) {
          reader.expect(after);
        }
        reader.take(line[i]);
      }
      EXPECT_EQ(reader.is_intact(before), session == before) << at;
      EXPECT_EQ(reader.is_intact(after), session == after) << at;
    }
  }
}

TEST(SerialRecord, WhatCannotBeOneIsDamaged) {
  const Bytes good = encode({1, 2, 3}, 0);
  struct Case {
    const char* why;
    Bytes stream;
    int damaged;
  };
  const Case cases[] = {
      {"nothing between delimiters is nothing", {0, 0, 0}, 0},
      {"a block that ends early", {5, 1, 2, 0}, 1},
      {"one byte short of the shortest", {6, 1, 2, 3, 4, 5, 0}, 1},
      {"the shortest, and no check", {7, 1, 2, 3, 4, 5, 6, 0}, 1},
      {"as long as there is room for, and no check", Bytes(60, 1), 0},
      {"text of another protocol", {'V', '1', '0', '1', '3', '\r', 0}, 1},
  };
  for (const Case& one : cases) {
    EXPECT_EQ(decode(one.stream, 0).damaged, one.damaged) << one.why;
    Bytes stream = one.stream;
    stream.push_back(0);
    stream.insert(stream.end(), good.begin(), good.end());
    EXPECT_EQ(decode(stream, 0).bodies.size(), 1U) << one.why << ": right again after it";
  }
}

TEST(SerialRecord, OneThatIsTooLongIsDamagedOnce) {
  Bytes stream(500, 0x55);
  stream.push_back(0);
  EXPECT_EQ(decode(stream, 0).damaged, 1);
}

TEST(SerialRecord, EveryChangeOfOneBitOrByteIsFound) {
  const Bytes line = encode({0x90, 0x00, 0x40, 0x0A, 0x02, 0x12, 0x34, 0x00, 0x2D}, 7);
  for (std::size_t at = 0; at < line.size(); ++at) {
    for (int value = 0; value < 256; ++value) {
      Bytes changed = line;
      changed[at] = static_cast<std::uint8_t>(value);
      if (changed != line) {
        EXPECT_TRUE(decode(changed, 7).bodies.empty()) << "byte " << at << " to " << value;
      }
    }
  }
}

// --- frames --------------------------------------------------------------------------------------

TEST(SerialFrame, ABodyThatNoBusCarriesIsRefused) {
  struct Case {
    const char* why;
    Bytes body;
  };
  const Case cases[] = {
      {"no tag", {}},
      {"no sequence", {0x90, 0, 0, 0}},
      {"no life", {0x90, 0, 0, 0, 0}},
      {"nine bytes", {0x90, 0, 0, 0, 0, 0xFF, 1, 2, 3, 4, 5, 6, 7, 8, 9}},
      {"a standard identifier of 12 bits", {0x00, 0, 0x08, 0, 0, 0xFF}},
      {"kind 3", {0x60, 0, 0, 0, 0, 0xFF}},
      {"kind 5", {0xA0, 0, 0, 0, 0, 0xFF}},
      {"an error report", {0x20, 0, 0, 4, 0, 0xFF}},
      {"a remote frame without a length", {0xC0, 0, 0, 0, 0, 0xFF}},
      {"a remote frame with data", {0xC0, 0, 0, 0, 0, 0xFF, 2, 1}},
      {"a remote frame of length 9", {0xC0, 0, 0, 0, 0, 0xFF, 9}},
  };
  for (const Case& one : cases) {
    Frame frame{};
    EXPECT_FALSE(read_frame(one.body.data(), static_cast<std::uint8_t>(one.body.size()),
                            frame_head_down, frame))
        << one.why;
  }
}

// --- life ----------------------------------------------------------------------------------------

TEST(SerialLife, IsTheLongestThatIsNotLonger) {
  struct Case {
    std::uint32_t units;
    std::uint8_t life;
    std::uint16_t told;
  };
  const Case cases[] = {
      {0, 0x00, 0},           {1, 0x01, 1},           {15, 0x0F, 15},
      {16, 0x18, 16},         {17, 0x18, 16},         {18, 0x19, 18},
      {31, 0x1F, 30},         {480, 0x5F, 480},       {488, 0x5F, 480},
      {976, 0x6F, 960},       {30'719, 0xBE, 28'672}, {30'720, 0xBF, 30'720},
      {32'767, 0xBF, 30'720}, {32'768, 0xBF, 30'720}, {4'000'000'000, 0xBF, 30'720},
  };
  for (const Case& one : cases) {
    EXPECT_EQ(life_of_units(one.units), one.life) << one.units;
    EXPECT_EQ(life_units(life_of_units(one.units)), one.told) << one.units;
  }
  for (std::uint32_t units = 1; units <= 30'720; ++units) {
    const std::uint32_t told = life_units(life_of_units(units));
    ASSERT_LE(told, units);
    ASSERT_LT((units - told) * 9, units) << units;
  }
}

}  // namespace
}  // namespace roio::serial
