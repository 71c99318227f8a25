#ifndef ROIO_LOCAL_CONNECTION_HPP
#define ROIO_LOCAL_CONNECTION_HPP

#include <cstdint>
#include <memory>
#include <optional>
#include <roio/bus.hpp>
#include <roio/parts/deadline.hpp>
#include <string>

#include "local/hub.hpp"
#include "local/memory.hpp"
#include "local/place.hpp"
#include "local/presence.hpp"
#include "local/stream.hpp"

namespace roio::local {

/// A client's connection after the hub's welcome.
struct Connection {
  Stream stream;
  ClientMemory memory;
  UniqueFd wake;  // readable when the hub has news
  Welcome welcome;
  pid_t hub;
};

/// Gets a client to a bus's hub, whichever process that is, and starts one here when there is none
/// and this process may.
class Connector {
 public:
  /// @param bitrate_bps what the bus must run at; none: whatever it does, and no limit for a hub
  /// here.
  /// @param carry whether the hub may be here.
  /// @throws std::system_error: see Place.
  Connector(const std::string& bus_name, std::optional<std::uint32_t> bitrate_bps, Carry carry);

  /// @param stop gives up when it is set.
  /// @return none: not before the deadline, or stopped; why_not() says why.
  /// @throws Errc::bitrate_mismatch, version_mismatch, bus_full, carried_already, not_permitted;
  /// system errors.
  std::optional<Connection> connect(const Deadline& deadline, const EventFlag& stop);

  /// This client's number.
  [[nodiscard]] std::uint64_t client() const { return client_; }

  /// Why connect() returned none.
  [[nodiscard]] std::system_error why_not() const;

  /// Before the connection ends: this client needs nothing any more that the bus still has for it.
  void end_presence() { presence_.end(); }
  /// Ends the hub, when it is here.
  void leave() { hub_.reset(); }

 private:
  [[nodiscard]] std::uint16_t wish_for_the_seat(const Place::Hub& hub) const;
  [[nodiscard]] bool may_claim(const Deadline& others_first) const;
  [[nodiscard]] bool is_between_hubs() const;
  void carry(HubSeat seat);
  std::optional<Connection> greet(Place::Hub hub, const EventFlag& stop);
  [[noreturn]] void throw_refused(const Refused& refused) const;

  std::string bus_name_;
  std::optional<std::uint32_t> bitrate_bps_;
  const Carry carry_;
  std::uint64_t client_;
  Place place_;
  std::unique_ptr<Hub> hub_;
  Presence presence_;              // from the first hub to the last
  std::optional<Deadline> rests_;  // a host that could not carry the bus
  bool was_connected_ = false;
  std::optional<pid_t> silent_hub_;  // the one that did not answer
};

}  // namespace roio::local

#endif
