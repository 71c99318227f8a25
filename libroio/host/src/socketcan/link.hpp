#ifndef ROIO_SOCKETCAN_LINK_HPP
#define ROIO_SOCKETCAN_LINK_HPP

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <roio/bus.hpp>
#include <roio/frame.hpp>
#include <roio/parts/bus_events.hpp>
#include <roio/parts/fd.hpp>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include "parts/fork.hpp"

namespace roio::socketcan {

/// A raw socket and the interface that it belongs to, through all that happens to the interface:
/// down and up, bus-off, deleted and made again under the same name. The socket stays the same one,
/// so its queue and its drop count do too. Safe in any thread.
class Link {
 public:
  /// @param events are told what happens to it.
  /// @param may_be_absent waits for the interface; else it must be there.
  /// @throws std::system_error naming the interface: Errc::no_can_support, no_such_interface,
  ///         not_a_can_interface, or the system's own.
  Link(std::string name, std::span<const SocketCanFilter> filters, BusEvents& events,
       bool may_be_absent);

  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] int socket() const noexcept { return socket_.get(); }
  /// Readable when there may be a reason to call read_news().
  [[nodiscard]] int news() const noexcept { return news_.get(); }

  /// Looks at the interface, and binds to it when it is a new one.
  void look();
  /// look(), unless the last one is recent: at most some 10 calls a second reach the kernel.
  void look_now_and_then();
  /// For a system call that said ENETDOWN, ENODEV or ENXIO: counts the outage, then looks.
  void went_down();
  /// Takes what news() announced, then looks.
  void read_news();

  /// Whether the interface was up, with a carrier and its controller on the bus, by the last look.
  /// Without a carrier the kernel throws frames away and calls them sent.
  [[nodiscard]] bool usable() const noexcept { return usable_.load(std::memory_order_relaxed); }
  /// Looks first.
  [[nodiscard]] BusState state();
  /// Looks first. Why there is no such interface; none: there is one.
  [[nodiscard]] std::optional<std::system_error> trouble();

  /// Decodes an error report (FrameKind::error) into state and counts.
  void report(const Frame& error);

  /// @throws std::system_error; the filters stay as they were.
  void set_filters(std::span<const SocketCanFilter> filters);
  /// Receives nothing from now on, error reports included, and never again.
  void mute() noexcept;

  /// The kernel may have had no room for frames.
  void count_lost();
  /// Writes dropped, error_frames, bus_offs, outages and overruns.
  void fill(Statistics& statistics);

 private:
  using Clock = std::chrono::steady_clock;
  enum class Interface : std::uint8_t { up, down, absent };

  void look_locked();
  [[nodiscard]] bool bind_locked(int interface_index);
  void set_interface(Interface now);
  void update_usable();
  void count_lost_locked();
  [[nodiscard]] BusState state_locked() const;
  void tell_news();

  const std::string name_;
  BusEvents& events_;
  const ParentsFd socket_;
  const UniqueFd news_;

  std::mutex mutex_;  // all below, but the atomics
  std::vector<SocketCanFilter> filters_;
  bool muted_ = false;
  bool carrier_ = true;
  Interface interface_ = Interface::absent;
  BusState controller_ = BusState::active;
  std::uint64_t dropped_ = 0;
  std::uint64_t error_frames_ = 0;
  std::uint64_t bus_offs_ = 0;
  std::uint64_t outages_ = 0;
  std::uint64_t overruns_ = 0;

  std::atomic<bool> usable_{false};
  std::atomic<Clock::rep> last_look_{0};  // since the clock's epoch
};

}  // namespace roio::socketcan

#endif
