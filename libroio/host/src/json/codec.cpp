#include <algorithm>
#include <array>
#include <roio/json.hpp>

#include "text/seconds.hpp"

namespace roio {
namespace {

std::string data_list(const Message& message, std::size_t length) {
  std::string out;
  for (std::size_t i = 0; i < length; ++i) {
    out += (i == 0 ? "" : ",") + std::to_string(message.data[i]);
  }
  return out;
}

// The fields of 2014, in their order.
std::string original_fields(const Message& message) {
  const Address destination = message.header.destination;
  const std::size_t length = std::min(message.length, max_data_length);
  std::string out = R"("type":"Roio","isBroadcast":)";
  out +=
      is_broadcast(destination) ? "true" : R"(false,"address":)" + std::to_string(destination.node);
  out += R"(,"subnet":)" + std::to_string(destination.subnet);
  out += R"(,"messageLength":)" + std::to_string(length);
  out += R"(,"data":[)" + data_list(message, length) + ']';
  return out;
}

// SECONDS.MICROSECONDS
std::string decimal_seconds(Timestamp time) {
  constexpr std::uint64_t us_per_s = 1000000;
  std::array<char, 6> fraction{};
  write_decimal(fraction.data(), microseconds(time) % us_per_s, fraction.size());
  return std::to_string(microseconds(time) / us_per_s) + '.' +
         std::string(fraction.data(), fraction.size());
}

}  // namespace

std::string to_json(const JsonMessage& message) {
  const Header& header = message.message.header;
  std::string out = '{' + original_fields(message.message);
  if (header.priority == Priority::urgent) {
    out += R"(,"priority":"urgent")";
  }
  if (header.message_class != MessageClass::message) {
    out += std::string(R"(,"class":")") + to_string(header.message_class) + '"';
  }
  if (message.has_source) {
    out += R"(,"source":")" + to_string(header.source) + '"';
  }
  if (message.time) {
    out += R"(,"timestamp":)" + decimal_seconds(*message.time);
  }
  return out + '}';
}

}  // namespace roio
