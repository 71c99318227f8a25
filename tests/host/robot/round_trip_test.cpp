// Random kinds and values: what goes in comes out, and the bytes are those of a second, slower way
// that writes a message as a text of 0 and 1.
#include <gtest/gtest.h>

#include <roio/kind.hpp>
#include <string>

#include "parsing.hpp"
#include "random_kind.hpp"
#include "random_value.hpp"
#include "seed.hpp"

namespace roio {
namespace {

/// "00000101" for 5 in 8 bits.
std::string binary(std::int64_t raw, unsigned width) {
  std::string out;
  for (unsigned i = 0; i < width; ++i) {
    out.insert(out.begin(), (static_cast<std::uint64_t>(raw) >> i & 1U) != 0 ? '1' : '0');
  }
  return out;
}

/// The rules of docs/robot-file.md, once more.
std::string bits_of(const MessageKind& message, const std::vector<Reading>& values) {
  std::string bits = message.tag ? binary(*message.tag, 8) : "";
  for (const Reading& value : values) {
    const bool fits_in_byte = bits.size() % 8 != 0 && bits.size() % 8 + value.field->width <= 8;
    while (!fits_in_byte && bits.size() % 8 != 0) {
      bits += '0';
    }
    if (value.field->form == Field::Form::bytes) {
      for (unsigned i = 0; i < value.bytes.length; ++i) {
        bits += binary(value.bytes.data[i], 8);
      }
    } else {
      bits += binary(value.raw, value.field->width);
    }
  }
  while (bits.size() % 8 != 0) {
    bits += '0';
  }
  return bits;
}

std::string bits_of(const Bytes& bytes) {
  std::string bits;
  for (unsigned i = 0; i < bytes.length; ++i) {
    bits += binary(bytes.data[i], 8);
  }
  return bits;
}

/// Packed as the values are, and as a person types what is shown of them.
void check_message(const MessageKind& message, std::mt19937& random) {
  std::vector<Reading> values;
  std::vector<NamedValue> said;
  std::vector<NamedValue> typed;
  for (const Field& field : message.fields) {
    values.push_back(test::random_value(field, random));
    said.push_back({field.name, test::value_of(values.back())});
    const auto read = parse_value(field, values.back().text());
    ASSERT_EQ(test::verdict(read), "ok") << values.back().text();
    typed.push_back({field.name, *read});
  }
  const auto bytes = pack(message, said);
  ASSERT_EQ(test::verdict(bytes), "ok");
  EXPECT_EQ(bits_of(*bytes), bits_of(message, values));
  const auto from_text = pack(message, typed);
  ASSERT_EQ(test::verdict(from_text), "ok");
  EXPECT_EQ(bits_of(*from_text), bits_of(*bytes));
  const auto readings = unpack(message, {bytes->data.data(), bytes->length});
  ASSERT_EQ(readings.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(readings[i].raw, values[i].raw) << values[i].field->name;
    EXPECT_EQ(readings[i].text(), values[i].text()) << values[i].field->name;
    EXPECT_TRUE(readings[i].is_valid()) << values[i].field->name;
  }
}

TEST(RoundTrip, RandomKindsAndValues) {
  std::mt19937 random = test::seeded_generator();
  test::RandomKind kinds(random);
  for (int i = 0; i < 1000 && !::testing::Test::HasFailure(); ++i) {
    const std::string text = kinds.text();
    const auto kind = parse_kind(text, "k");
    ASSERT_EQ(test::verdict(kind), "ok") << text;
    for (int j = 0; j < 8 && !::testing::Test::HasFailure(); ++j) {
      check_message(kind->heard[0], random);
    }
    EXPECT_FALSE(::testing::Test::HasFailure()) << text;
  }
}

}  // namespace
}  // namespace roio
