#ifndef ROIO_LOCAL_CONNECTION_HPP
#define ROIO_LOCAL_CONNECTION_HPP

#include <cstdint>
#include <memory>
#include <optional>
#include <roio/parts/deadline.hpp>
#include <string>

#include "local/counters.hpp"
#include "local/hub.hpp"
#include "local/place.hpp"
#include "local/stream.hpp"

namespace roio::local {

/// A client's connection after the hub's welcome.
struct Connection {
  Stream stream;
  CounterPage page;
  Welcome welcome;
};

/// Gets a client to a bus's hub, whichever process that is, and starts one here when there is none
/// and this process may.
class Connector {
 public:
  /// @param bitrate_bps what the bus must run at; none: whatever it does, and no limit for a hub
  /// here.
  /// @param may_be_hub else only other processes are.
  /// @throws std::system_error: see Place.
  Connector(const std::string& bus_name, std::optional<std::uint32_t> bitrate_bps, bool may_be_hub);

  /// @param stop gives up when it is set.
  /// @return none: not before the deadline, or stopped.
  /// @throws Errc::bitrate_mismatch, version_mismatch, not_permitted; system errors.
  std::optional<Connection> connect(const Deadline& deadline, const EventFlag& stop);

  /// Ends the hub, when it is here.
  void leave() { hub_.reset(); }

 private:
  std::optional<Connection> greet(UniqueFd socket, const Deadline& deadline, const EventFlag& stop);
  [[noreturn]] void throw_refused(const Refused& refused) const;

  std::string bus_name_;
  std::optional<std::uint32_t> bitrate_bps_;
  const bool may_be_hub_;
  bool was_connected_ = false;
  std::uint64_t client_;
  Place place_;
  std::unique_ptr<Hub> hub_;

 public:
  [[nodiscard]] std::uint64_t client() const { return client_; }
};

}  // namespace roio::local

#endif
