/// Which messages have a name on the way from one place of a robot to another.
#ifndef ROIO_CLI_KIND_WAYS_HPP
#define ROIO_CLI_KIND_WAYS_HPP

#include <roio/robot.hpp>
#include <vector>

namespace roio::cli {

/// From a place to another, or to everybody of a subnet: one identifier on the bus, for messages of
/// normal priority.
struct Way {
  const Place* source = nullptr;
  const Place* destination = nullptr;  ///< Null: everybody of `subnet`.
  std::uint8_t subnet = 0;             ///< Of the destination.
  std::vector<const MessageKind*> messages;

  [[nodiscard]] Header header() const;
};

/// All on which a message has a name, as Robot::meaning() has it. A place with a kind sends what
/// that says; one without, what its receiver hears. By source, then destination, in the order of
/// the file, each source's broadcasts behind.
std::vector<Way> ways_of(const Robot& robot);

/// On one identifier a DBC tells messages apart by a number in a fixed place, and by nothing else.
struct Distinction {
  std::vector<const MessageKind*> told;    ///< Have signals; with more than one, all have tags.
  std::vector<const MessageKind*> untold;  ///< It takes their length to know them.
  std::vector<const MessageKind*> empty;   ///< Of 0 bytes: no signal can be misread in them.
};
Distinction distinguish(const std::vector<const MessageKind*>& messages);

}  // namespace roio::cli

#endif
