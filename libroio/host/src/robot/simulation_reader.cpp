#include "robot/simulation_reader.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "robot/limits.hpp"
#include "text/decimal.hpp"

namespace roio::robot_file {
namespace {

constexpr std::uint64_t lowest_crystal_hz = 1000000;
constexpr std::uint64_t highest_crystal_hz = 40000000;  // the MCP2515's limit
constexpr std::size_t max_path = 1000;
constexpr const char* pin_rule = R"(a pin such as "3" or "A0")";

struct PartName {
  const char* name;
  PinPart::Type type;
};

constexpr std::array<PartName, 6> part_names{{{"servo", PinPart::Type::servo},
                                              {"led", PinPart::Type::led},
                                              {"fan", PinPart::Type::fan},
                                              {"button", PinPart::Type::button},
                                              {"potentiometer", PinPart::Type::potentiometer},
                                              {"light", PinPart::Type::light}}};

/// "3", "A0": one or two digits, without a leading zero.
bool is_pin(std::string_view text) {
  if (text.starts_with('A')) {
    text.remove_prefix(1);
  }
  return text.size() <= 2 && read_decimal(text).has_value();
}

std::string read_board(const At& at) {
  const std::string expected = "one of uno, nano, leonardo, micro, mega";
  const std::string& board = at.text(expected);
  for (const std::string_view known : {"uno", "nano", "leonardo", "micro", "mega"}) {
    if (board == known) {
      return board;
    }
  }
  at.refuse(expected);
}

PinPart::Type read_part_type(const At& at) {
  const std::string expected = "one of servo, led, fan, button, potentiometer, light";
  const std::string& type = at.text(expected);
  for (const PartName& known : part_names) {
    if (type == known.name) {
      return known.type;
    }
  }
  at.refuse(expected);
}

/// A number is as good as its digits.
std::optional<std::string> read_pin(const Object& simulation, std::string_view name) {
  const auto at = simulation.find(name);
  if (!at) {
    return std::nullopt;
  }
  if ((!at->is(Value::Type::text) && !at->is(Value::Type::number)) || !is_pin(at->value().text)) {
    at->refuse(pin_rule);
  }
  return at->value().text;
}

std::string cs_of(const SimulatedBoard& board) {
  return board.cs_pin.value_or("10");
}

std::string int_of(const SimulatedBoard& board) {
  return board.int_pin.value_or("2");
}

void refuse_one_pin(const Object& simulation, const SimulatedBoard& board) {
  if (cs_of(board) == int_of(board)) {
    const auto at = simulation.find("int");
    (at ? at : simulation.find("cs"))
        ->wrong("CS and INT are both on pin " + cs_of(board) + "; expected two pins");
  }
}

void refuse_taken(const At& at, const SimulatedBoard& board, const PinPart& part) {
  if (part.pin == cs_of(board) || part.pin == int_of(board)) {
    at.wrong("the pin is that of the MCP2515's CS or INT; expected another");
  }
  for (const PinPart& other : board.pins) {
    if (other.name == part.name) {
      at.wrong(quote(part.name) + " hangs on pin " + other.pin + ", too; expected another name");
    }
  }
}

PinPart read_part(const At& at) {
  if (!is_pin(at.name())) {
    at.wrong(std::string("not a pin; expected ") + pin_rule);
  }
  const Object object(at, {"type", "name"});
  PinPart part;
  part.pin = at.name();
  part.type = read_part_type(object.need("type", "what hangs on the pin"));
  part.name = object.need("name", "a name for it").identifier();
  return part;
}

void read_pins(const At& at, SimulatedBoard& board) {
  if (!at.is(Value::Type::object)) {
    at.refuse("an object, pin to what hangs on it");
  }
  for (const At& place : at.children()) {
    const PinPart part = read_part(place);
    refuse_taken(place, board, part);
    board.pins.push_back(part);
  }
}

}  // namespace

SimulatedBoard read_simulation(const At& at, const std::filesystem::path& folder) {
  const Object object(at, {"board", "firmware", "crystal", "cs", "int", "pins"});
  SimulatedBoard board;
  board.board = read_board(object.need("board", "one of uno, nano, leonardo, micro, mega"));
  board.firmware = folder / object.need("firmware", "an ELF file or a sketch").line(1, max_path);
  if (const auto crystal = object.find("crystal")) {
    board.crystal_hz =
        static_cast<std::uint32_t>(crystal->whole(lowest_crystal_hz, highest_crystal_hz));
  }
  board.cs_pin = read_pin(object, "cs");
  board.int_pin = read_pin(object, "int");
  refuse_one_pin(object, board);
  if (const auto pins = object.find("pins")) {
    read_pins(*pins, board);
  }
  return board;
}

}  // namespace roio::robot_file
