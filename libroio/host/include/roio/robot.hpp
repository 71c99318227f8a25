/// Robot: which boards a robot has, where, and what they say to each other. Target roio::robot.
///
///   const auto robot = roio::load_robot("robot.json");
///   node.send(*robot->encode("arm", "angles", {{"shoulder", 90}, {"elbow", 45}, {"hand", 0}}));
///   if (const auto named = robot->decode(message)) { ... named->kind->name, named->readings ... }
///
/// A place is what a robot has; a board is what stands there for now.
/// Source: docs/robot-file.md.
#ifndef ROIO_ROBOT_HPP
#define ROIO_ROBOT_HPP

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <optional>
#include <roio/export.hpp>
#include <roio/kind.hpp>
#include <roio/message.hpp>
#include <roio/text.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace roio {

/// What hangs on a pin of a simulated board.
struct PinPart {
  enum class Type : std::uint8_t { servo, led, fan, button, potentiometer, light };

  std::string pin;  ///< As on the board: "3", "A0".
  Type type = Type::led;
  std::string name;  ///< "shoulder".
};

/// What roio-sim needs to stand in for the board of a place.
struct SimulatedBoard {
  std::string board;               ///< "uno", "nano", "leonardo", "micro" or "mega".
  std::filesystem::path firmware;  ///< An ELF file or a sketch. One that the file has relative to
                                   ///< itself has the file's folder in front of it here.
  std::uint32_t crystal_hz = 16000000;
  std::optional<std::string> cs_pin;   ///< None: 10.
  std::optional<std::string> int_pin;  ///< None: 2.
  std::vector<PinPart> pins;
};

struct Place {
  std::string name;  ///< 1..32 letters, digits, '-' and '_', a letter first. Unique.
  std::string description;
  Address address{};                 ///< 0..31 . 0..254. Unique.
  std::shared_ptr<const Kind> kind;  ///< Null: a board whose messages have no names.
  std::vector<NamedValue> settings;  ///< Of the kind's; those alone that the robot sets.
  std::optional<SimulatedBoard> simulation;
};

/// What a message means.
struct NamedMessage {
  const MessageKind* kind = nullptr;  ///< Of a place's kind, which the robot keeps.
  std::vector<Reading> readings;
};

class ROIO_EXPORT Robot {
 public:
  std::string name;
  std::string description;
  std::string version;  ///< These three as the file says; empty: it does not.
  std::string serial_number;
  std::string maker;
  std::string bus;                       ///< As open() takes it; empty: not named.
  std::optional<std::uint32_t> bitrate;  ///< 1,000..1,000,000 bit/s.
  std::vector<Place> places;             ///< In the order of the file.
  std::filesystem::path file;            ///< Where it was read from.

  /// @return null: there is none.
  [[nodiscard]] const Place* find(std::string_view place) const noexcept;
  [[nodiscard]] const Place* find(Address address) const noexcept;

  /// A place's name, or SUBNET.NODE or SUBNET.* as parse_address() takes it.
  /// @return an error names the places there are that are spelt alike.
  [[nodiscard]] Parsed<Address> address_of(std::string_view text) const;

  /// "arm", or "0.7" where no place is.
  [[nodiscard]] std::string name_of(Address address) const;

  /// What a message of that name is called by its sender (what its kind says), else by its receiver
  /// (what that hears), else, of a broadcast, by the receivers of that subnet, if those that have
  /// the name agree on the bytes.
  /// @return an error says which messages there are.
  [[nodiscard]] Parsed<const MessageKind*> message(Address source, Address destination,
                                                   std::string_view message_name) const;

  /// Whether bytes are called something else on their way than the message that they were packed
  /// as: a sender's own messages go before those that the receiver hears.
  /// @return none: they are not, and may be called nothing; else what they are.
  [[nodiscard]] std::optional<ParseError> objection(Address source, Address destination,
                                                    const MessageKind& message,
                                                    const Bytes& bytes) const;

  /// A message to a place, from nobody (0.*, which no bus takes as a source): Node::send() puts its
  /// own address in. Normal priority.
  /// @return an error as of message(), pack() and address_of().
  [[nodiscard]] Parsed<Message> encode(std::string_view destination, std::string_view message,
                                       std::span<const NamedValue> values) const;
  [[nodiscard]] Parsed<Message> encode(std::string_view destination, std::string_view message,
                                       std::initializer_list<NamedValue> values) const;

  /// What `data` is called on its way: the order of message(). Class message alone has names.
  /// @return null: by nobody, or of a broadcast not the same by all.
  [[nodiscard]] const MessageKind* meaning(const Header& header,
                                           std::span<const std::uint8_t> data) const noexcept;
  [[nodiscard]] std::optional<NamedMessage> decode(const Message& message) const;
};

struct LoadOptions {
  /// Where kinds are looked for after the robot file's own folder and `kinds` in it, and before
  /// roio/kinds in $XDG_DATA_HOME (none: ~/.local/share) and in each of $XDG_DATA_DIRS (none:
  /// /usr/local/share, /usr/share).
  std::vector<std::filesystem::path> kind_folders;
};

/// Reads a robot and the kinds that it names. @return errors as those of load_kind().
ROIO_EXPORT Parsed<Robot> load_robot(const std::filesystem::path& file,
                                     const LoadOptions& options = {});

/// The robot file that holds in a folder: robot.json in it, or in the nearest folder above. A file
/// of that name that is not ours (an object with the field "roio") is passed over; one that cannot
/// be read is not, so that load_robot() says why.
ROIO_EXPORT std::optional<std::filesystem::path> find_robot_file(
    const std::filesystem::path& folder);

}  // namespace roio

#endif
