#include "serial/trouble.hpp"

#include <roio/error.hpp>

namespace roio::serial {
namespace {

std::string text_of(Status status) {
  switch (status) {
    case Status::bad_argument:
      return "a value is out of its range";
    case Status::no_chip:
      return "no MCP2515 answers the board; check its wires and its power";
    case Status::wrong_mode:
      return "the controller does not get onto the bus; check CANH and CANL for a short circuit";
    case Status::bad_timing:
      return "the controller cannot make this bit rate from its crystal";
    default:
      return to_string(status);
  }
}

Trouble other_version(const SerialSession::OtherVersion& other, const std::string& name) {
  std::string bridge = "a bridge of protocol version " + std::to_string(other.protocol);
  if (other.firmware) {
    bridge += " (firmware " + to_string(*other.firmware) + ")";
  }
  return {{Errc::version_mismatch, name + ": " + bridge + ", and this is version " +
                                       std::to_string(protocol_version) +
                                       "; `scripts/flash` puts the matching firmware on the board"},
          bridge};
}

}  // namespace

std::optional<Trouble> trouble_of(const SerialSession& session, const std::string& name) {
  if (session.refusal()) {
    const std::string text = text_of(*session.refusal());
    return Trouble{{Errc::bridge_refused, name + ": " + text}, text};
  }
  if (session.other_version()) {
    return other_version(*session.other_version(), name);
  }
  return std::nullopt;
}

std::system_error request_error(const std::string& what, const SerialSession::Reply& reply) {
  if (reply.kind == SerialSession::Reply::Kind::answered) {
    return {Errc::bridge_refused, what + ": " + text_of(reply.status)};
  }
  return {Errc::no_bridge, what};
}

}  // namespace roio::serial
