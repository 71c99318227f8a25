#include "robot/robot_reader.hpp"

#include "robot/alike.hpp"
#include "robot/at.hpp"
#include "robot/document.hpp"
#include "robot/file.hpp"
#include "robot/kind_library.hpp"
#include "robot/limits.hpp"
#include "robot/name.hpp"
#include "robot/simulation_reader.hpp"
#include "robot/value_rule.hpp"

namespace roio {
namespace robot_file {
namespace {

const Field* find_setting(const Kind& kind, std::string_view name) {
  for (const Field& field : kind.settings) {
    if (field.name == name) {
      return &field;
    }
  }
  return nullptr;
}

std::vector<std::string> setting_names(const Kind& kind) {
  std::vector<std::string> names;
  for (const Field& field : kind.settings) {
    names.push_back(field.name);
  }
  return names;
}

NamedValue read_setting(const At& at, const Kind& kind) {
  const Field* field = find_setting(kind, at.name());
  if (field == nullptr) {
    at.wrong("no setting of a " + kind.name + "; " +
             advice(at.name(), setting_names(kind), "it has none"));
  }
  const bool is_choice = field->form == Field::Form::choice;
  if (!at.is(is_choice ? Value::Type::text : Value::Type::number)) {
    at.refuse(expected_of(*field));
  }
  const RawOrNot raw = is_choice ? raw_of(*field, FieldValue(at.value().text))
                                 : raw_of_number_text(*field, at.value().text);
  if (const auto* why = std::get_if<NotOfField>(&raw)) {
    at.wrong(why->message);
  }
  return {field->name, value_of(*field, std::get<std::int64_t>(raw))};
}

std::vector<NamedValue> read_settings(const At& at, const Kind* kind) {
  if (!at.is(Value::Type::object)) {
    at.refuse("an object, name to value");
  }
  if (kind == nullptr) {
    at.wrong("the place has no kind, which would say what can be set; expected a kind");
  }
  std::vector<NamedValue> settings;
  for (const At& setting : at.children()) {
    settings.push_back(read_setting(setting, *kind));
  }
  return settings;
}

Address read_address(const At& at) {
  const std::string expected = R"(an address, "SUBNET.NODE", such as "0.2")";
  const Parsed<Address> address = parse_source(at.text(expected));
  if (!address) {
    at.wrong(address.error().message);
  }
  return *address;
}

void refuse_taken(const At& at, const Robot& robot, Address address) {
  if (const Place* other = robot.find(address)) {
    at.wrong(quote(to_string(address)) + " is the address of " + other->name +
             "; expected another");
  }
}

class RobotReader {
 public:
  RobotReader(const std::filesystem::path& file, const LoadOptions& options)
      : file_(file), kinds_(file, options) {}

  Robot read(const Source& source) {
    const Value document = read_document(source);
    const Object object = file_object(source, document,
                                      {"$schema", "roio", "name", "description", "version",
                                       "serialNumber", "maker", "bus", "places"});
    Robot robot;
    robot.file = file_;
    robot.name = object.need("name", "the robot's name").line(1, max_title);
    robot.description = object.line("description", 0, max_description);
    robot.version = object.line("version", 0, max_title);
    robot.serial_number = object.line("serialNumber", 0, max_title);
    robot.maker = object.line("maker", 0, max_title);
    if (const auto bus = object.find("bus")) {
      read_bus(*bus, robot);
    }
    read_places(object.need("places", "an object, name to place"), robot);
    return robot;
  }

 private:
  static void read_bus(const At& at, Robot& robot) {
    const Object object(at, {"name", "bitrate"});
    if (const auto bitrate = object.find("bitrate")) {
      robot.bitrate = static_cast<std::uint32_t>(bitrate->whole(1000, 1000000));
    }
    const auto name = object.find("name");
    if (!name) {
      return;
    }
    robot.bus = name->line(1, max_bus);
    const Parsed<BusUrl> url = parse_bus_url(robot.bus);
    if (!url) {
      name->wrong(url.error().message);
    }
    if (url->bitrate && robot.bitrate && url->bitrate != robot.bitrate) {
      name->wrong(quote(robot.bus) + ", but \"bitrate\" says " + std::to_string(*robot.bitrate));
    }
  }

  void read_places(const At& at, Robot& robot) {
    if (!at.is(Value::Type::object)) {
      at.refuse("an object, name to place");
    }
    for (const At& place : at.children()) {
      robot.places.push_back(read_place(place, robot));
    }
  }

  Place read_place(const At& at, const Robot& robot) {
    if (!is_name(at.name())) {
      at.wrong(std::string("not a name; expected ") + name_rule);
    }
    const Object object(at, {"address", "kind", "settings", "description", "simulation"});
    Place place;
    place.name = at.name();
    place.description = object.line("description", 0, max_description);
    const At address = object.need("address", R"(one, such as "0.2")");
    place.address = read_address(address);
    refuse_taken(address, robot, place.address);
    if (const auto kind = object.find("kind")) {
      place.kind = kinds_.get(*kind);
    }
    if (const auto settings = object.find("settings")) {
      place.settings = read_settings(*settings, place.kind.get());
    }
    if (const auto simulation = object.find("simulation")) {
      place.simulation = read_simulation(*simulation, file_.parent_path());
    }
    return place;
  }

  std::filesystem::path file_;
  KindLibrary kinds_;
};

}  // namespace

Parsed<Robot> parse_robot(std::string_view text, const std::filesystem::path& file,
                          const LoadOptions& options) {
  const std::string origin = file.string();
  try {
    return RobotReader(file, options).read(Source(text, origin));
  } catch (const Refused& refused) {
    return refused.error();
  }
}

}  // namespace robot_file

Parsed<Robot> load_robot(const std::filesystem::path& file, const LoadOptions& options) {
  const Parsed<std::string> text = robot_file::read_file(file);
  if (!text) {
    return text.error();
  }
  return robot_file::parse_robot(*text, file, options);
}

}  // namespace roio
