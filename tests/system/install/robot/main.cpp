// A consumer of roio::robot: makes a message by names, says what it means.
#include <iostream>
#include <roio/robot.hpp>

int main(int, char** arguments) {
  const auto robot = roio::load_robot(arguments[1]);
  if (!robot) {
    std::cerr << robot.error().message << '\n';
    return 1;
  }
  const auto message =
      robot->encode("arm", "angles", {{"shoulder", 90}, {"elbow", 45}, {"hand", 0}});
  const auto named = robot->decode(*message);
  const roio::Reading& first = named->readings.front();
  std::cout << robot->name_of(message->header.destination) << ' ' << named->kind->name << ' '
            << roio::to_hex(message->data, message->length) << ", " << first.field->name << ' '
            << first.text() << ' ' << first.field->unit << '\n';
}
