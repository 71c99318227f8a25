// Frames between the places of a robot at random, a line of JSON each, with what Robot::decode()
// makes of them: make_frames ROBOT COUNT, so many at most
#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>
#include <roio/robot.hpp>

#include "random_kind.hpp"
#include "seed.hpp"

namespace roio::test {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Robot& robot, const Message& message) {
  Json line{{"id", pack_id(message.header)}, {"source", robot.name_of(message.header.source)}};
  line["data"] = to_hex(message.data, message.length);
  const auto named = robot.decode(message);
  if (!named) {
    return line;
  }
  line["message"] = named->kind->name;
  line["length"] = named->kind->max_length;
  line["fields"] = Json::array();
  for (const Reading& reading : named->readings) {
    const bool is_bytes = reading.field->form == Field::Form::bytes;
    Json field{{"name", reading.field->name}, {"value", reading.value()}};
    if (is_bytes) {
      field["bytes"] = std::vector<int>(reading.bytes.data.begin(),
                                        reading.bytes.data.begin() + reading.bytes.length);
    }
    if (reading.field->form == Field::Form::choice && reading.is_valid()) {
      field["choice"] = reading.text();
    }
    line["fields"].push_back(field);
  }
  return line;
}

template <typename T>
const T& any_of(std::mt19937& random, const std::vector<T>& all) {
  return all.at(std::uniform_int_distribution<std::size_t>(0, all.size() - 1)(random));
}

/// A message that a place's kind says or hears, from or to it, or to everybody.
void print_frame(std::mt19937& random, const Robot& robot) {
  const Place& place = any_of(random, robot.places);
  const Address other = any_of(random, robot.places).address;
  const bool is_said = any_of<int>(random, {0, 1}) == 1;
  if (!place.kind || (is_said ? place.kind->said : place.kind->heard).empty()) {
    return;
  }
  Message message{};
  message.header.priority = Priority::normal;
  message.header.source = is_said ? place.address : other;
  message.header.destination = is_said ? other : place.address;
  if (any_of<int>(random, {0, 1, 2, 3}) == 0) {
    message.header.destination.node = broadcast_node;
  }
  const Bytes bytes =
      random_bytes(random, any_of(random, is_said ? place.kind->said : place.kind->heard));
  message.length = bytes.length;
  std::copy(bytes.data.begin(), bytes.data.end(), message.data);
  if (message.header.source != message.header.destination) {
    std::cout << json_of(robot, message) << '\n';
  }
}

}  // namespace
}  // namespace roio::test

int main(int argc, char** argv) {
  if (argc != 3) {
    return 2;
  }
  std::mt19937 random = roio::test::seeded_generator();
  const auto robot = roio::load_robot(argv[1]);
  if (!robot) {
    std::cerr << robot.error().message << '\n';
    return 1;
  }
  for (int i = std::stoi(argv[2]); i > 0; --i) {
    roio::test::print_frame(random, *robot);
  }
  return 0;
}
