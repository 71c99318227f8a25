/// SerialSession: the PC's side of docs/internals/serial-protocol.md, without any I/O: bytes and
/// the time go in, bytes to be sent come out. So it runs beside a port as well as in simulated
/// time.
///
///   session.begin(now);                       // a port has been opened
///   for (;;) {
///     // Sets the port to session.line_rate_bps() first, then sends session.output().
///     // Waits for bytes, until session.deadline() at most.
///     session.receive(bytes, now);
///     session.on_time(now);
///   }
///
/// Whenever the line rate changes, nothing is left in output() that was for the rate before.
/// Not for several threads at once.
#ifndef ROIO_SERIAL_SESSION_HPP
#define ROIO_SERIAL_SESSION_HPP

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <roio/bridge.hpp>
#include <roio/serial_protocol.hpp>
#include <roio/status.hpp>
#include <span>
#include <utility>
#include <vector>

#include "serial/arrivals.hpp"
#include "serial/clock.hpp"
#include "serial/down.hpp"
#include "serial/known_bridge.hpp"
#include "serial/line_rate.hpp"
#include "serial/output.hpp"
#include "serial/reports.hpp"
#include "serial/requests.hpp"
#include "serial/results_watch.hpp"
#include "serial/set_up.hpp"
#include "serial/settings.hpp"

namespace roio {

// NOLINTNEXTLINE(clang-analyzer-optin.performance.Padding): members stand by what they are for
class SerialSession {
 public:
  using Time = serial::Time;
  /// Gives numbers that are hard to guess and never come again, as far as possible.
  using Nonces = std::function<std::uint32_t()>;

  enum class Phase : std::uint8_t {
    closed,      ///< No port, or BYE has been said.
    calling,     ///< HELLO is repeated.
    speeding,    ///< SPEED was asked for.
    trying,      ///< The new rate is on trial.
    setting_up,  ///< Bit rate, filter and the rest are told to the bridge.
    ready,       ///< Frames go down. Up they come from `trying` on.
  };

  using Arrived = serial::Arrived;
  using Reply = SerialReply;
  /// Called once, from within any call of the session.
  using Done = serial::Done;

  /// The bridge speaks another version of the protocol.
  struct OtherVersion {
    std::uint8_t protocol;
    std::optional<FirmwareVersion> firmware;  ///< If it says so where version 1 does.
  };

  struct Counters {
    std::uint64_t sessions = 0;
    std::uint64_t damaged = 0;
    std::uint64_t retries = 0;
    std::uint64_t failed_trials = 0;
    std::uint64_t step_downs = 0;
  };

  SerialSession(SerialSettings settings, Nonces nonces);

  // --- the line ----------------------------------------------------------------------------------

  /// A port is there: HELLO goes out, until it is answered.
  void begin(Time now);
  /// There is none any more. Frames that the bridge may have are unknown from now on.
  void end();
  void receive(std::span<const std::uint8_t> bytes, Time now);
  /// To be called at deadline(), or earlier.
  void on_time(Time now);
  /// Time::max(): nothing goes by time now.
  [[nodiscard]] Time deadline() const;

  [[nodiscard]] std::uint32_t line_rate_bps() const { return line_rate_.bps(); }
  [[nodiscard]] std::span<const std::uint8_t> output() const { return output_.bytes(); }
  /// So many bytes of it have been sent.
  void consume_output(std::size_t count) { output_.consume(count); }

  // --- frames ------------------------------------------------------------------------------------

  /// Accepts frames as long as there is room, and there is little: 64 of a priority.
  /// @return how many; none unless the phase is `ready`.
  std::size_t offer(std::span<const Frame> frames, Time now);
  /// Drops those that wait.
  void drop_waiting() { down_.drop_waiting(); }
  /// How many wait for room in the window.
  [[nodiscard]] std::size_t waiting() const { return down_.waiting(); }
  /// How many have no outcome yet.
  [[nodiscard]] std::size_t unsettled() const { return down_.unsettled(); }
  /// Whether the outcome of all frames offered is known.
  [[nodiscard]] bool all_done() const { return down_.done(); }
  [[nodiscard]] const serial::DownFrames::Counters& down() const { return down_.counters(); }

  /// What has arrived since the last call.
  std::vector<Arrived> take_arrived() { return arrivals_.take_all(); }
  /// Losses so far are not told with the next frame.
  void forget_losses() { arrivals_.forget_losses(); }
  /// Frames due that did not come, in all sessions.
  [[nodiscard]] std::uint64_t lost() const { return arrivals_.lost(); }

  // --- requests ----------------------------------------------------------------------------------

  // Settings are kept for further sessions once the bridge has taken them; rules in any case.
  void set_bus(std::uint32_t bitrate_bps, BridgeMode mode, Time now, Done done);
  void set_rules(std::vector<serial::Rule> rules, Time now, Done done);
  void set_address(Address address, Time now, Done done);
  void identify(std::uint8_t seconds, Time now, Done done);
  /// Ends the session; the phase is `closed` after it.
  void leave(Time now, Done done);
  /// counter_reports() grows when they have come.
  void ask_counters(Time now);

  // --- what is known -----------------------------------------------------------------------------

  [[nodiscard]] Phase phase() const { return phase_; }
  /// port is empty.
  [[nodiscard]] BridgeInfo info() const;
  [[nodiscard]] const BridgeCounters& bridge_counters() const { return reports_.counters(); }
  [[nodiscard]] std::uint64_t counter_reports() const { return reports_.count(); }
  [[nodiscard]] Counters counters() const;
  /// Since begin(): why there is no session though a bridge answers.
  [[nodiscard]] const std::optional<OtherVersion>& other_version() const { return other_version_; }
  /// Since begin(): the bridge cannot do what the settings say, and is not used.
  [[nodiscard]] const std::optional<Status>& refusal() const { return refusal_; }

 private:
  // Incoming, in session_up.cpp; false: it makes no sense.
  void take_record(std::span<const std::uint8_t> body, Time now);
  bool take_control(std::span<const std::uint8_t> body, Time now);
  bool take_frame(std::span<const std::uint8_t> body, Time now);
  bool take_welcome(std::span<const std::uint8_t> payload, Time now);
  bool take_status(std::span<const std::uint8_t> payload, Time now);
  bool take_counters(std::span<const std::uint8_t> payload);
  bool take_results(std::span<const std::uint8_t> payload, Time now);
  bool take_reply(std::span<const std::uint8_t> payload, Time now);
  void take_speed_reply(std::uint8_t number, Status status, Time now);
  bool take_echoed(std::span<const std::uint8_t> payload, Time now);
  void count_damaged(Time now);

  // Outgoing.
  void write_control(serial::Down operation, std::span<const std::uint8_t> payload);
  void write(const serial::Requests::Question& question);
  void say_hello(Time now);
  void poll(Time now);
  void send_frames(Time now);
  [[nodiscard]] std::uint8_t life_until(Time end, Time now) const;

  // The course of a session.
  [[nodiscard]] Time course_deadline() const;
  [[nodiscard]] bool in_session() const { return phase_ > Phase::calling; }
  [[nodiscard]] bool is_settled() const { return phase_ == Phase::ready && !requests_.under_way(); }
  void call(Time now);
  void lose(Time now);
  void refuse(Status status, Time now);
  void open_session(const serial::Welcome& welcome, Time now);
  void go_on(Time now);
  void serve_timers(Time now);
  void check_progress(Time now);

  // The line rate.
  bool ask_speed(Time now);
  void miss_speed(Time now);
  void begin_trial(Time now);
  void send_echoes(Time now);
  void fail_trial(Time now);
  void step_down_if_needed(Time now);

  // Requests.
  void queue(serial::Request request, Time now);
  void ask(serial::Request request, Time now) { write(requests_.ask(std::move(request), now)); }
  void ask_next(Time now);
  void repeat_request(Time now);

  SerialSettings settings_;
  Nonces nonces_;
  Phase phase_ = Phase::closed;
  std::uint32_t session_ = serial::no_session;
  std::uint32_t last_session_ = serial::no_session;  // whose frames arrivals_ has counted
  serial::LineRate line_rate_;
  serial::Output output_;
  serial::RecordReader reader_;
  serial::Requests requests_;
  serial::SetUp set_up_;
  std::uint8_t speed_request_ = 0;  // SPEED's number

  serial::DownFrames down_;
  serial::ResultsWatch results_;
  serial::Arrivals arrivals_;

  // By time. Each counts in some phases only.
  Time hello_at_{0};
  Time poll_at_{0};
  Time heard_at_{0};     // the last intact record
  Time speed_until_{0};  // REPLY to SPEED, or the end of the trial
  Time echo_at_{0};

  serial::KnownBridge bridge_;
  serial::CounterReports reports_;
  unsigned polls_ = 0;
  bool counters_wanted_ = false;
  std::optional<OtherVersion> other_version_;
  std::optional<Status> refusal_;
  Counters counters_;  // but for retries, which requests_ counts
};

}  // namespace roio

#endif
