#ifndef ROIO_SERIAL_TROUBLE_HPP
#define ROIO_SERIAL_TROUBLE_HPP

#include <optional>
#include <string>
#include <system_error>

#include "serial/session.hpp"

namespace roio::serial {

/// Why a bridge that answers gives no session: what to throw for it, and the same in a few words.
struct Trouble {
  std::system_error error;
  std::string in_short;
};
/// None: there is nothing known that is wrong.
std::optional<Trouble> trouble_of(const SerialSession& session, const std::string& name);

/// For a request whose reply is not ok.
std::system_error request_error(const std::string& what, const SerialSession::Reply& reply);

}  // namespace roio::serial

#endif
