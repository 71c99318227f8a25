// A consumer of roio::json: reads a message, says it again.
#include <iostream>
#include <roio/json.hpp>

int main() {
  const auto message = roio::parse_json(
      R"({"type":"Roio","subnet":0,"address":2,"isBroadcast":false,"messageLength":3,"data":[90,45,0]})");
  if (!message) {
    std::cerr << message.error().message << '\n';
    return 1;
  }
  std::cout << roio::to_json(*message) << '\n';
}
