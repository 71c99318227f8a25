/// What a program's event loop does with a bus, for tests: sleeps until something is told, takes
/// it.
#ifndef ROIO_TESTS_CONTRACT_EVENT_LOOP_HPP
#define ROIO_TESTS_CONTRACT_EVENT_LOOP_HPP

#include <gtest/gtest.h>
#include <poll.h>

#include <chrono>
#include <ostream>
#include <roio/bus.hpp>

namespace roio {

inline bool operator==(const Events& a, const Events& b) {
  return a.room == b.room && a.state == b.state && a.loss == b.loss && a.filters == b.filters &&
         a.reply == b.reply && a.closed == b.closed;
}

inline std::ostream& operator<<(std::ostream& out, const Events& events) {
  const auto name = [&out](bool is_told, const char* text) { out << (is_told ? text : ""); };
  name(!events.any(), "nothing");
  name(events.room, "room ");
  name(events.state, "state ");
  name(events.loss, "loss ");
  name(events.filters, "filters ");
  name(events.reply, "reply ");
  name(events.closed, "closed ");
  return out;
}

}  // namespace roio

namespace roio::test {

/// A guard against hanging, never a measure.
inline constexpr std::chrono::seconds event_guard{30};
/// How long to listen for what should not come.
inline constexpr std::chrono::milliseconds event_moment{30};

inline bool has_events(const Bus& bus,
                       std::chrono::milliseconds timeout = std::chrono::milliseconds(0)) {
  pollfd entry{bus.event_fd(), POLLIN, 0};
  return ::poll(&entry, 1, static_cast<int>(timeout.count())) == 1;
}

/// As an event loop does: sleeps until something is told.
inline Events next_events(Bus& bus) {
  const auto end = std::chrono::steady_clock::now() + event_guard;
  for (;;) {
    if (!has_events(bus, event_guard)) {
      ADD_FAILURE() << "no event";
      return {};
    }
    if (const Events events = bus.take_events(); events.any()) {
      return events;
    }
    if (std::chrono::steady_clock::now() > end) {
      ADD_FAILURE() << "event_fd() is readable, and there is nothing";
      return {};
    }
  }
}

/// Nothing is told, and a loop would sleep. News of other interfaces may wake it for nothing.
inline void expect_no_events(Bus& bus) {
  if (has_events(bus, event_moment)) {
    EXPECT_EQ(bus.take_events(), Events{});
  }
  EXPECT_FALSE(has_events(bus)) << "it spins";
}

}  // namespace roio::test

#endif
