// The small words: addresses, status, version.
#include <gtest/gtest.h>

#include <roio/address.hpp>
#include <roio/status.hpp>
#include <roio/version.hpp>
#include <set>
#include <string>

namespace roio {
namespace {

struct AddressCase {
  const char* why;
  Address address;
  bool destination;
  bool source;
  bool broadcast;
};

TEST(Address, SaysWhatItMayStandFor) {
  const AddressCase cases[] = {
      {"all zero is an ordinary node", {0, 0}, true, true, false},
      {"largest node", {0, 254}, true, true, false},
      {"one past it is the broadcast address", {0, 255}, true, false, true},
      {"largest subnet", {31, 254}, true, true, false},
      {"one past it does not fit five bits", {32, 0}, false, false, false},
      {"largest subnet, everybody", {31, 255}, true, false, true},
      {"subnet out of range, everybody", {255, 255}, false, false, true},
  };
  for (const AddressCase& row : cases) {
    SCOPED_TRACE(row.why);
    EXPECT_EQ(is_valid_destination(row.address), row.destination);
    EXPECT_EQ(is_valid_source(row.address), row.source);
    EXPECT_EQ(is_broadcast(row.address), row.broadcast);
  }
}

TEST(Address, EqualsOnlyItself) {
  EXPECT_TRUE((Address{1, 2} == Address{1, 2}));
  EXPECT_TRUE((Address{1, 2} != Address{1, 3}));
  EXPECT_TRUE((Address{1, 2} != Address{2, 2}));
  EXPECT_TRUE((broadcast_of(7) == Address{7, 255}));
}

TEST(Status, EachHasItsOwnWords) {
  const Status all[] = {Status::ok,         Status::bad_argument,  Status::full,
                        Status::not_roio,   Status::unknown_class, Status::empty,
                        Status::no_chip,    Status::wrong_mode,    Status::bad_timing,
                        Status::wrong_clock};
  std::set<std::string> words;
  for (const Status status : all) {
    words.insert(to_string(status));
  }
  EXPECT_EQ(words,
            (std::set<std::string>{"ok", "bad argument", "full", "not a Roio frame",
                                   "unknown class", "nothing received", "no controller answers",
                                   "controller not in the mode asked for", "impossible bit timing",
                                   "controller runs at another clock"}));
  EXPECT_STREQ(to_string(static_cast<Status>(10)), "unknown status");
}

TEST(Version, TextIsTheNumbers) {
  const std::string expected = std::to_string(ROIO_VERSION_MAJOR) + "." +
                               std::to_string(ROIO_VERSION_MINOR) + "." +
                               std::to_string(ROIO_VERSION_PATCH);
  EXPECT_EQ(ROIO_VERSION, expected);
}

}  // namespace
}  // namespace roio
