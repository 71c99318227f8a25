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

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <roio/bridge.hpp>
#include <roio/serial_protocol.hpp>
#include <roio/status.hpp>
#include <span>
#include <utility>
#include <vector>

#include "serial/clock.hpp"
#include "serial/down.hpp"
#include "serial/line_rate.hpp"
#include "serial/payloads.hpp"
#include "serial/reports.hpp"
#include "serial/up.hpp"

namespace roio {

struct SerialSettings {
  std::uint32_t line_rate_bps = 1'000'000;     ///< The highest to be used.
  std::optional<std::uint32_t> bitrate_bps{};  ///< None: as the bridge has it.
  std::optional<BridgeMode> mode{};            ///< None: as the bridge has it.
  std::optional<Address> address{};            ///< None: as the bridge has it.
  /// At most serial::max_rules, of which one must match; none: as the bridge has them.
  std::optional<std::vector<serial::Rule>> rules{};
};

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

  struct Arrived {
    Frame frame;
    Time time;                  ///< When the bridge read it, by the clock of `now`.
    std::uint64_t lost_before;  ///< Frames due that did not come, between the one before and this.
  };

  /// What became of a request.
  struct Reply {
    enum class Kind : std::uint8_t {
      answered,    ///< status is the bridge's.
      unanswered,  ///< However often it was asked.
      no_session,  ///< There is none, or it ended.
    };
    Kind kind = Kind::unanswered;
    Status status = Status::ok;

    [[nodiscard]] bool ok() const { return kind == Kind::answered && status == Status::ok; }
  };
  /// Called once, from within any call of the session.
  using Done = std::function<void(Reply)>;

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
  [[nodiscard]] std::span<const std::uint8_t> output() const { return output_; }
  /// So many bytes of it have been sent.
  void consume_output(std::size_t count);

  // --- frames ------------------------------------------------------------------------------------

  /// Accepts frames as long as there is room, and there is little: 64 of a priority.
  /// @return how many; none unless the phase is `ready`.
  std::size_t offer(std::span<const Frame> frames, Time now);
  /// Drops those that wait.
  void drop_waiting() { down_.drop_waiting(); }
  /// How many wait for room in the window.
  [[nodiscard]] std::size_t waiting() const { return down_.waiting(); }
  /// Whether the outcome of all frames offered is known.
  [[nodiscard]] bool all_done() const { return down_.done(); }
  [[nodiscard]] const serial::DownFrames::Counters& down() const { return down_.counters(); }

  /// What has arrived since the last call.
  std::vector<Arrived> take_arrived() { return std::exchange(arrived_, {}); }
  /// Losses so far are not told with the next frame.
  void forget_losses() { lost_told_ = up_.lost(); }
  /// Frames due that did not come, in all sessions.
  [[nodiscard]] std::uint64_t lost() const { return up_.lost(); }

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
  [[nodiscard]] const Counters& counters() const { return counters_; }
  /// Since begin(): why there is no session though a bridge answers.
  [[nodiscard]] const std::optional<OtherVersion>& other_version() const { return other_version_; }
  /// Since begin(): the bridge cannot do what the settings say, and is not used.
  [[nodiscard]] const std::optional<Status>& refusal() const { return refusal_; }

 private:
  struct Request {
    serial::Down operation;
    std::vector<std::uint8_t> payload;  // what comes after the request's number
    Done done;
  };
  struct Asked {
    Request request;
    std::uint8_t number;
    unsigned tries;
    Time repeat_at;
  };

  // Incoming; false: it makes no sense.
  void take_record(std::span<const std::uint8_t> body, Time now);
  bool take_control(std::span<const std::uint8_t> body, Time now);
  bool take_frame(std::span<const std::uint8_t> body, Time now);
  bool take_welcome(std::span<const std::uint8_t> payload, Time now);
  bool take_status(std::span<const std::uint8_t> payload, Time now);
  bool take_counters(std::span<const std::uint8_t> payload);
  bool take_results(std::span<const std::uint8_t> payload, Time now);
  bool take_reply(std::span<const std::uint8_t> payload, Time now);
  void take_speed_reply(std::uint8_t number, const Reply& reply, Time now);
  bool take_echoed(std::span<const std::uint8_t> payload, Time now);
  void count_damaged(Time now);

  // Outgoing.
  template <typename Body>
  void write(std::uint32_t session, const Body& body);
  void write_control(serial::Down operation, std::span<const std::uint8_t> payload);
  void write_numbered(serial::Down operation, std::uint8_t number,
                      std::span<const std::uint8_t> payload);
  void say_hello(Time now);
  void append_hello();
  void poll(Time now);
  void send_frames(Time now);
  [[nodiscard]] bool line_is_clogged() const;

  // The course of a session.
  [[nodiscard]] bool in_session() const { return phase_ > Phase::calling; }
  [[nodiscard]] bool controller_works() const;
  void call(Time now);
  void lose(Time now);
  void refuse(Status status, Time now);
  void open_session(const serial::Welcome& welcome, Time now);
  [[nodiscard]] bool is_still(const serial::Welcome& welcome) const;
  void go_on(Time now);
  void set_up_bus(Time now);
  void serve_timers(Time now);
  void check_progress(Time now);

  // The line rate.
  void ask_speed(Time now);
  void miss_speed(Time now);
  void begin_trial(Time now);
  void send_echoes(Time now);
  void fail_trial(Time now);
  void step_down_if_needed(Time now);

  // Requests: one is under way at a time.
  void queue(Request request, Time now);
  void ask_next(Time now);
  void ask(Request request, Time now);
  void write_request(Time now);
  void repeat_request(Time now);
  void finish_request(const Reply& reply);
  void answer_all(Reply::Kind kind);

  enum class SetUp : std::uint8_t { speed, bus, address, rules, done };

  SerialSettings settings_;
  Nonces nonces_;
  Phase phase_ = Phase::closed;
  std::uint32_t session_ = serial::no_session;
  std::uint32_t last_session_ = serial::no_session;  // whose frames up_ has counted
  serial::LineRate line_rate_;
  std::vector<std::uint8_t> output_;
  serial::RecordReader reader_;

  serial::DownFrames down_;
  serial::UpCount up_;
  serial::RepeatedFrames repeated_;
  std::uint64_t lost_told_ = 0;
  serial::BridgeClock clock_;
  std::vector<Arrived> arrived_;

  // By time. Each counts in some phases only.
  Time hello_at_{0};
  Time poll_at_{0};
  Time heard_at_{0};     // the last intact record
  Time speed_until_{0};  // REPLY to SPEED, or the end of the trial
  Time echo_at_{0};
  Time progress_at_{0};  // RESULTS last came forward, or there was nothing that it could tell
  Time results_at_{0};   // RESULTS last came, or there was nothing to come

  // The session's course.
  SetUp set_up_step_ = SetUp::speed;
  std::uint8_t last_request_ = 0;
  std::optional<Asked> asked_;
  std::deque<Request> requests_;
  unsigned polls_ = 0;
  std::uint32_t previous_session_ = serial::no_session;  // before this one, as WELCOME had it
  unsigned questions_ = 0;                               // for the crystal
  unsigned impossible_ = 0;                              // STATUS in a row

  // What is known of the bridge.
  BridgeInfo info_;
  serial::CounterReports reports_;
  bool counters_wanted_ = false;
  std::optional<OtherVersion> other_version_;
  std::optional<Status> refusal_;
  Counters counters_;
};

}  // namespace roio

#endif
