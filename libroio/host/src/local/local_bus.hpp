#ifndef ROIO_LOCAL_LOCAL_BUS_HPP
#define ROIO_LOCAL_LOCAL_BUS_HPP

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <roio/bus.hpp>
#include <roio/parts/bus_events.hpp>
#include <roio/parts/deadline.hpp>
#include <roio/parts/thread.hpp>
#include <roio/parts/waits.hpp>
#include <span>
#include <string>
#include <system_error>

#include "local/carrier_watch.hpp"
#include "local/connection.hpp"
#include "local/inbox.hpp"
#include "local/outbox.hpp"

namespace roio::local {

/// The client of a local bus. A thread of its own reads, so that frames, and a hub to be replaced,
/// do not wait for the program to call.
class LocalBus final : public Bus {
 public:
  /// @throws std::system_error: see open().
  LocalBus(const std::string& bus_name, std::optional<std::uint32_t> bitrate_bps,
           const OpenOptions& options);

  LocalBus(const LocalBus&) = delete;
  LocalBus& operator=(const LocalBus&) = delete;
  ~LocalBus() override { close(); }

  using Bus::receive;
  using Bus::send;
  Transfer send(std::span<const Frame> frames, Timeout timeout) override;
  Transfer receive(std::span<Received> frames, Timeout timeout) override;
  void set_filters(std::span<const SocketCanFilter> filters) override;
  void begin_set_filters(std::span<const SocketCanFilter> filters) override;
  [[nodiscard]] int fd() const noexcept override { return inbox_.readable().fd(); }
  [[nodiscard]] int event_fd() const noexcept override { return events_.fd(); }
  Events take_events() override { return events_.take(); }
  [[nodiscard]] BusState state() const override;
  [[nodiscard]] std::optional<std::system_error> trouble() const override;
  [[nodiscard]] Statistics statistics() const override;
  [[nodiscard]] std::optional<std::size_t> listeners() const override;
  void cancel() noexcept override { waits_.cancel(); }
  void resume() noexcept override { waits_.resume(); }
  void close() noexcept override;
  void begin_close() noexcept override;
  [[nodiscard]] const std::string& name() const noexcept override { return name_; }

 private:
  void await_first_look();

  /// To the hub.
  struct Link {
    Stream stream;
    UniqueFd wake;
    pid_t hub;
  };

  // The caller holds mutex_ for these.
  std::optional<std::size_t> offer(std::span<const Frame> frames);
  std::size_t take(std::span<Received> frames);
  void adopt(Connection connection);
  void settle();
  void ask_for_done();
  void flush();
  void tell_if_waited_for();
  void make_room();
  void look_for_events();
  [[nodiscard]] bool is_over() const;

  // The reading thread.
  void run();
  void finish();
  void work();
  bool prepare_to_sleep();
  void sleep();
  void disconnect();
  void reconnect();
  void note_trouble(const std::system_error& trouble);

  std::string name_;
  const std::system_error no_memory_;  // made while there is some
  Connector connector_;                // the reading thread's
  const Timeout open_timeout_;
  bool has_looked_ = false;  // the reading thread, for a hub
  BusEvents events_;
  EventFlag stop_;  // to look for a hub
  EventFlag wake_;  // the reading thread has bytes to send, too
  Waits waits_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;  // link_ or trouble_
  std::optional<Link> link_;         // changed by the reading thread only
  std::optional<std::system_error> trouble_;
  Inbox inbox_;
  Outbox outbox_;
  bool sender_waits_ = false;       // for room
  std::uint64_t settled_seen_ = 0;  // by the reading thread
  CarrierWatch watch_;
  std::optional<Deadline> closing_;
  Statistics statistics_;

  SharedThread thread_;  // last: it uses all of the above
};

}  // namespace roio::local

#endif
