/// What happens to a bus between its frames, noticed by looking.
#ifndef ROIO_CLI_BUS_WATCH_HPP
#define ROIO_CLI_BUS_WATCH_HPP

#include <cstdint>
#include <functional>
#include <roio/bus.hpp>

#include "form/record_format.hpp"
#include "listen/hub_watch.hpp"

namespace roio::cli {

class BusWatch {
 public:
  using Tell = std::function<void(const BusNews&)>;

  /// @param bus outlives this.
  BusWatch(const Bus& bus, Tell tell);

  /// Tells what has changed. Asks the kernel, so not to be called for every frame.
  void look();
  /// Tells of the CAN FD frames that have not been told of yet. The first are told as soon as they
  /// come, so that nobody waits for what cannot be shown; the others at the end.
  void tell_fd_frames();
  [[nodiscard]] std::uint64_t fd_frames() const { return told_fd_frames_; }

 private:
  void announce(BusState state);

  const Bus& bus_;
  Tell tell_;
  bool is_local_;
  BusState state_ = BusState::active;
  std::uint64_t outages_ = 0;
  std::uint64_t told_fd_frames_ = 0;
  HubWatch hub_watch_;
};

}  // namespace roio::cli

#endif
