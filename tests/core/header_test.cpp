#include <gtest/gtest.h>

#include <roio/header.hpp>
#include <tuple>

#include "seed.hpp"

namespace roio {
namespace {

// docs/protocol.md "Header", field by field.
static_assert(PriorityField::mask() == 0x10000000, "bit 28");
static_assert(ClassField::mask() == 0x0C000000, "bits 27..26");
static_assert(DestinationSubnetField::mask() == 0x03E00000, "bits 25..21");
static_assert(DestinationNodeField::mask() == 0x001FE000, "bits 20..13");
static_assert(SourceSubnetField::mask() == 0x00001F00, "bits 12..8");
static_assert(SourceNodeField::mask() == 0x000000FF, "bits 7..0");
static_assert(id_mask == 0x1FFFFFFF, "29 bits");
static_assert(sizeof(Header) == 6, "a byte a field");
static_assert(pack_id(Header{Priority::normal, MessageClass::message, {0, 2}, {0, 10}}) ==
                  0x1000400A,
              "usable at compile time");
static_assert(unpack_id(0x1000400A) ==
                  Header{Priority::normal, MessageClass::message, {0, 2}, {0, 10}},
              "usable at compile time");

constexpr Header zero{Priority::urgent, MessageClass::message, {0, 0}, {0, 0}};

struct FieldCase {
  const char* why;
  Header header;
  std::uint32_t id;
  bool may_be_sent;
};

Header with(void (*change)(Header&)) {
  Header header = zero;
  change(header);
  return header;
}

TEST(Header, EachFieldAtZeroAtItsLargestAndOnePast) {
  const FieldCase cases[] = {
      {"all zero", zero, 0x00000000, true},
      {"priority 1", with([](Header& h) { h.priority = Priority::normal; }), 0x10000000, true},
      {"priority 2 is cut off", with([](Header& h) { h.priority = static_cast<Priority>(2); }),
       0x00000000, false},
      {"class 2", with([](Header& h) { h.message_class = MessageClass::stream; }), 0x08000000,
       true},
      {"class 3 is reserved", with([](Header& h) { h.message_class = MessageClass::reserved; }),
       0x0C000000, false},
      {"class 4 is cut off",
       with([](Header& h) { h.message_class = static_cast<MessageClass>(4); }), 0x00000000, false},
      {"destination subnet 31", with([](Header& h) { h.destination.subnet = 31; }), 0x03E00000,
       true},
      {"destination subnet 32 is cut off", with([](Header& h) { h.destination.subnet = 32; }),
       0x00000000, false},
      {"destination node 254", with([](Header& h) { h.destination.node = 254; }), 0x001FC000, true},
      {"destination node 255 is a broadcast", with([](Header& h) { h.destination.node = 255; }),
       0x001FE000, true},
      {"source subnet 31", with([](Header& h) { h.source.subnet = 31; }), 0x00001F00, true},
      {"source subnet 32 is cut off", with([](Header& h) { h.source.subnet = 32; }), 0x00000000,
       false},
      {"source node 254", with([](Header& h) { h.source.node = 254; }), 0x000000FE, true},
      {"source node 255 is nobody", with([](Header& h) { h.source.node = 255; }), 0x000000FF,
       false},
      {"all at their largest",
       {Priority::normal, MessageClass::stream, {31, 255}, {31, 254}},
       0x1BFFFFFE,
       true},
  };
  for (const FieldCase& row : cases) {
    SCOPED_TRACE(row.why);
    EXPECT_EQ(pack_id(row.header), row.id);
    EXPECT_EQ(is_valid(row.header), row.may_be_sent);
    constexpr std::uint32_t untouched = 0xA5A5A5A5;
    std::uint32_t id = untouched;
    EXPECT_EQ(make_id(row.header, id), row.may_be_sent ? Status::ok : Status::bad_argument);
    EXPECT_EQ(id, row.may_be_sent ? row.id : untouched);
  }
}

template <typename Field>
void expect_every_value_stays_in_its_field() {
  for (std::uint32_t value = 0; value <= Field::largest(); ++value) {
    const std::uint32_t id = Field::put(value);
    ASSERT_EQ(id & ~Field::mask(), 0U);
    ASSERT_EQ(id >> Field::lsb, value);
    ASSERT_EQ(Field::get(id), value);
    ASSERT_EQ(Field::get(id | ~Field::mask()), value) << "the other bits do not matter";
    ASSERT_EQ(pack_id(unpack_id(id)), id);
    ASSERT_EQ(pack_id(unpack_id(id | (id_mask & ~Field::mask()))), id | (id_mask & ~Field::mask()));
  }
  EXPECT_EQ(Field::put(Field::largest() + 1U), 0U);
}

TEST(Header, EveryValueOfEveryField) {
  expect_every_value_stays_in_its_field<PriorityField>();
  expect_every_value_stays_in_its_field<ClassField>();
  expect_every_value_stays_in_its_field<DestinationSubnetField>();
  expect_every_value_stays_in_its_field<DestinationNodeField>();
  expect_every_value_stays_in_its_field<SourceSubnetField>();
  expect_every_value_stays_in_its_field<SourceNodeField>();
}

TEST(Header, BitsAboveTheIdentifierAreIgnored) {
  EXPECT_EQ(unpack_id(0xE0000000), zero);
  EXPECT_EQ(unpack_id(0xFFFFFFFF), unpack_id(0x1FFFFFFF));
}

/// The header as the document says it, in plain arithmetic.
std::uint32_t reference_id(const Header& header) {
  std::uint32_t id = static_cast<std::uint32_t>(header.priority);
  id = id * 4 + static_cast<std::uint32_t>(header.message_class);
  id = id * 32 + header.destination.subnet;
  id = id * 256 + header.destination.node;
  id = id * 32 + header.source.subnet;
  return id * 256 + header.source.node;
}

Header random_header(std::mt19937& generator) {
  const auto byte = [&generator](std::uint32_t max) {
    return static_cast<std::uint8_t>(test::up_to(generator, max));
  };
  return {static_cast<Priority>(byte(1)),
          static_cast<MessageClass>(byte(2)),
          {byte(31), byte(255)},
          {byte(31), byte(254)}};
}

TEST(Header, AMillionRandomOnesComeBack) {
  std::mt19937 generator = test::seeded_generator();
  for (int i = 0; i < 1'000'000; ++i) {
    const Header header = random_header(generator);
    std::uint32_t id = 0;
    ASSERT_EQ(make_id(header, id), Status::ok);
    ASSERT_EQ(id, reference_id(header));
    ASSERT_EQ(unpack_id(id), header);
  }
}

TEST(Header, AMillionRandomIdentifiersComeBack) {
  std::mt19937 generator = test::seeded_generator();
  for (int i = 0; i < 1'000'000; ++i) {
    const std::uint32_t id = test::up_to(generator, id_mask);
    ASSERT_EQ(pack_id(unpack_id(id)), id);
  }
}

/// docs/protocol.md "Priority", in its words.
auto precedence(const Header& header) {
  return std::tuple(header.priority, header.message_class, header.destination.subnet,
                    header.destination.node, header.source.subnet, header.source.node);
}

TEST(Header, PrecedenceIsTheOrderOfTheNumbers) {
  std::mt19937 generator = test::seeded_generator();
  for (int i = 0; i < 100'000; ++i) {
    const Header a = random_header(generator);
    Header b = random_header(generator);
    // Headers that agree in their first fields, so that every field gets to decide.
    b.priority = i % 2 == 0 ? a.priority : b.priority;
    b.message_class = i % 4 == 0 ? a.message_class : b.message_class;
    b.destination.subnet = i % 8 == 0 ? a.destination.subnet : b.destination.subnet;
    b.destination.node = i % 16 == 0 ? a.destination.node : b.destination.node;
    b.source.subnet = i % 32 == 0 ? a.source.subnet : b.source.subnet;
    ASSERT_EQ(pack_id(a) < pack_id(b), precedence(a) < precedence(b));
    ASSERT_EQ(pack_id(a) == pack_id(b), precedence(a) == precedence(b));
  }
}

TEST(Header, DiffersInEachField) {
  const Header a{Priority::normal, MessageClass::system, {1, 2}, {3, 4}};
  for (std::uint32_t bit = 0; bit < 29; ++bit) {
    EXPECT_NE(unpack_id(pack_id(a) ^ (1U << bit)), a) << "bit " << bit;
  }
}

}  // namespace
}  // namespace roio
