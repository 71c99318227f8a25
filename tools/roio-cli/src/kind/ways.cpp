#include "kind/ways.hpp"

#include <algorithm>
#include <array>
#include <set>

namespace roio::cli {
namespace {

constexpr unsigned byte_values = 256;

/// Whether there are bytes that mean just this message there: another may have taken them all.
bool occurs(const Robot& robot, const Header& header, const MessageKind& message) {
  for (std::size_t length = message.min_length; length <= message.max_length; ++length) {
    const bool any_first = !message.tag && length > 0;
    for (unsigned first = 0; first < (any_first ? byte_values : 1); ++first) {
      std::array<std::uint8_t, max_data_length> data{};
      data[0] = message.tag ? *message.tag : static_cast<std::uint8_t>(first);
      if (robot.meaning(header, std::span(data.data(), length)) == &message) {
        return true;
      }
    }
  }
  return false;
}

void add_occurring(const Robot& robot, const std::vector<MessageKind>& messages, Way& way) {
  for (const MessageKind& message : messages) {
    const bool is_known = std::find(way.messages.begin(), way.messages.end(), &message) !=
                          way.messages.end();  // of two places of one kind
    if (!is_known && occurs(robot, way.header(), message)) {
      way.messages.push_back(&message);
    }
  }
}

bool hears(const Place& place, const Way& way) {
  return way.destination == nullptr ? place.address.subnet == way.subnet
                                    : &place == way.destination;
}

void add_way(const Robot& robot, Way way, std::vector<Way>& ways) {
  if (way.source->kind && !way.source->kind->said.empty()) {
    add_occurring(robot, way.source->kind->said, way);
  } else {
    for (const Place& place : robot.places) {
      if (place.kind && hears(place, way)) {
        add_occurring(robot, place.kind->heard, way);
      }
    }
  }
  if (!way.messages.empty()) {
    ways.push_back(std::move(way));
  }
}

/// Whether a frame of one may have the length and the number in the tag's place of the other.
bool are_alike(const MessageKind& a, const MessageKind& b) {
  return !a.tag || !b.tag || *a.tag == *b.tag;
}

}  // namespace

Header Way::header() const {
  const Address to =
      destination == nullptr ? Address{subnet, broadcast_node} : destination->address;
  return {Priority::normal, MessageClass::message, to, source->address};
}

std::vector<Way> ways_of(const Robot& robot) {
  std::set<std::uint8_t> subnets;
  for (const Place& place : robot.places) {
    subnets.insert(place.address.subnet);
  }
  std::vector<Way> ways;
  for (const Place& source : robot.places) {
    for (const Place& destination : robot.places) {
      if (&source != &destination) {
        add_way(robot, {&source, &destination, destination.address.subnet, {}}, ways);
      }
    }
    for (const std::uint8_t subnet : subnets) {
      add_way(robot, {&source, nullptr, subnet, {}}, ways);
    }
  }
  return ways;
}

Distinction distinguish(const std::vector<const MessageKind*>& messages) {
  Distinction result;
  for (const MessageKind* message : messages) {
    if (message->max_length == 0) {
      result.empty.push_back(message);
      continue;
    }
    const bool is_told = std::none_of(messages.begin(), messages.end(), [&](const auto* other) {
      return other != message && other->max_length > 0 && are_alike(*message, *other);
    });
    (is_told ? result.told : result.untold).push_back(message);
  }
  return result;
}

}  // namespace roio::cli
