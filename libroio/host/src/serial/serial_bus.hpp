#ifndef ROIO_SERIAL_SERIAL_BUS_HPP
#define ROIO_SERIAL_SERIAL_BUS_HPP

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <roio/bridge.hpp>
#include <roio/parts/bus_events.hpp>
#include <roio/parts/deadline.hpp>
#include <roio/parts/receive_queue.hpp>
#include <roio/parts/thread.hpp>
#include <roio/parts/waits.hpp>
#include <roio/text.hpp>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include "serial/controller_watch.hpp"
#include "serial/filters.hpp"
#include "serial/port_opener.hpp"
#include "serial/replies.hpp"
#include "serial/session.hpp"
#include "serial/wall_clock.hpp"

namespace roio::serial {

/// A bridge as a bus. A thread of its own serves port and session, so that neither waits for the
/// program to call.
class SerialBus final : public Bus, public Bridge {
 public:
  /// @throws std::system_error: see open().
  SerialBus(const BusUrl& url, const OpenOptions& options);

  SerialBus(const SerialBus&) = delete;
  SerialBus& operator=(const SerialBus&) = delete;
  ~SerialBus() override { close(); }

  using Bus::receive;
  using Bus::send;
  Transfer send(std::span<const Frame> frames, Timeout timeout) override;
  Transfer receive(std::span<Received> frames, Timeout timeout) override;
  void set_filters(std::span<const SocketCanFilter> filters) override;
  void begin_set_filters(std::span<const SocketCanFilter> filters) override;
  [[nodiscard]] int fd() const noexcept override { return queue_.readable().fd(); }
  [[nodiscard]] int event_fd() const noexcept override { return events_.fd(); }
  Events take_events() override { return events_.take(); }
  [[nodiscard]] BusState state() const override;
  [[nodiscard]] std::optional<std::system_error> trouble() const override;
  [[nodiscard]] Statistics statistics() const override;
  void cancel() noexcept override { waits_.cancel(); }
  void resume() noexcept override { waits_.resume(); }
  void close() noexcept override;
  void begin_close() noexcept override;
  [[nodiscard]] const std::string& name() const noexcept override { return name_; }

  [[nodiscard]] BridgeInfo info() const override;
  [[nodiscard]] BridgeLineCounters line_counters() const override;
  [[nodiscard]] BridgeCounters counters(Timeout timeout) override;
  void set_bus(std::uint32_t bitrate_bps, BridgeMode mode, Timeout timeout) override;
  void set_address(std::optional<Address> address, Timeout timeout) override;
  void identify(std::chrono::seconds duration, Timeout timeout) override;

  std::uint32_t begin_counters() override;
  std::uint32_t begin_set_bus(std::uint32_t bitrate_bps, BridgeMode mode) override;
  std::uint32_t begin_set_address(std::optional<Address> address) override;
  std::uint32_t begin_identify(std::chrono::seconds duration) override;
  std::optional<BridgeReply> take_reply() override;

 private:
  using Lock = std::unique_lock<std::mutex>;
  using Reply = SerialSession::Reply;
  using Done = SerialSession::Done;

  /// A request: for errors, and how it is put.
  struct Question {
    std::string what;
    std::function<void(Done)> ask;
  };
  Question bus_question(std::uint32_t bitrate_bps, BridgeMode mode);
  Question address_question(std::optional<Address> address);
  Question identify_question(std::chrono::seconds duration);
  void request(const Question& question, Timeout timeout);
  std::uint32_t begin(const Question& question);

  void await_session();

  /// COUNTERS was asked for: the first report after these is the answer.
  struct CountersAsked {
    std::uint32_t id;
    std::uint64_t reports_before;
    Deadline until;
  };

  // The caller holds mutex_ for these.
  [[nodiscard]] bool is_ready() const { return session_.phase() == SerialSession::Phase::ready; }
  [[nodiscard]] std::optional<std::system_error> known_trouble() const;
  [[nodiscard]] BusState known_state() const;
  [[nodiscard]] Statistics all_statistics() const;
  void take_filters(std::span<const SocketCanFilter> filters, Done done);
  void answer(BridgeReply reply);
  void answer_counters(bool all);
  void look_for_events();
  void flush();
  void deliver();
  void enqueue(const Frame& frame, Timestamp time);
  void follow_session();
  void follow_controller();
  std::optional<Reply> await_reply(Lock& lock, Timeout timeout,
                                   const std::function<void(Done)>& ask);

  // The serving thread.
  void run();
  void serve();
  void reopen();
  bool is_over();
  void finish();

  const std::string name_;
  const bool error_frames_;
  Deadline open_until_;  // the serving thread's: after it, that no bridge answers is a trouble
  PortOpener opener_;    // the serving thread's
  BusEvents events_;
  EventFlag stop_;  // to look for a port
  EventFlag wake_;  // the serving thread is to look at the session
  Waits waits_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;  // anything that somebody may wait for
  std::string path_;                 // none: not found yet
  Filters filters_;
  std::uint64_t filters_set_ = 0;  // how often
  SerialSession session_;
  std::optional<SerialPort> port_;  // replaced by the serving thread only
  bool port_failed_ = false;
  bool was_ready_ = false;  // when last looked at
  std::optional<std::system_error> trouble_;
  std::error_code told_trouble_;
  ReceiveQueue queue_{16384};
  std::uint64_t lost_before_us_ = 0;  // of the session's count, before open() returned
  std::size_t waiting_seen_ = 0;      // in the session
  Time awake_at_{0};                  // the serving thread, if nothing else wakes it
  WallClock wall_clock_;
  ControllerWatch controller_;
  std::uint64_t counter_reports_seen_ = 0;
  Statistics statistics_;

  Replies replies_;
  std::vector<CountersAsked> counters_asked_;

  std::optional<Deadline> closing_;  // until frames are handed over, then until BYE is answered
  bool leaving_ = false;             // BYE has been said
  bool left_ = false;                // and answered
  SharedThread thread_;              // last: it uses all of the above
};

}  // namespace roio::serial

#endif
