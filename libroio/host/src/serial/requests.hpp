/// Requests: what is asked of the bridge and answered by REPLY: one at a time, repeated until it is
/// answered, but not for ever. Source: docs/internals/serial-protocol.md
/// "Control records, down".
#ifndef ROIO_SERIAL_REQUESTS_HPP
#define ROIO_SERIAL_REQUESTS_HPP

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <roio/serial_protocol.hpp>
#include <roio/status.hpp>
#include <span>
#include <vector>

#include "serial/clock.hpp"

namespace roio {

/// What became of a request.
struct SerialReply {
  enum class Kind : std::uint8_t {
    answered,    ///< status is the bridge's.
    unanswered,  ///< However often it was asked.
    no_session,  ///< There is none, or it ended.
  };
  Kind kind = Kind::unanswered;
  Status status = Status::ok;

  [[nodiscard]] bool ok() const { return kind == Kind::answered && status == Status::ok; }
  /// Whether the bridge has what it was told, and keeps it, though it may be unable to act on it
  /// now (no controller, for instance).
  [[nodiscard]] bool is_kept() const {
    return kind == Kind::answered && status != Status::bad_argument && status != Status::bad_timing;
  }
};

namespace serial {

using Reply = SerialReply;
/// Called once.
using Done = std::function<void(Reply)>;

struct Request {
  Down operation;
  std::vector<std::uint8_t> payload;  ///< What comes after the request's number.
  Done done;                          ///< May be empty.
};

/// No I/O: says what is to be written, and is told what has come. Not for calls from within Done,
/// but for queue().
class Requests {
 public:
  static constexpr unsigned max_tries = 4;

  /// To be written to the bridge at once; holds until the next call.
  struct Question {
    Down operation;
    std::uint8_t number;
    std::span<const std::uint8_t> payload;
  };

  /// After those that wait already.
  void queue(Request request) { waiting_.push_back(std::move(request)); }
  /// The next that waits gets its turn. None: none waits, or one is under way.
  std::optional<Question> next(Time now);
  /// This one gets its turn, before those that wait; none must be under way.
  Question ask(Request request, Time now);
  /// For a question that is asked elsewhere: its number, which no other has.
  std::uint8_t take_number() { return ++last_number_; }

  [[nodiscard]] bool under_way() const { return asked_.has_value(); }
  /// When the one under way is due again; Time::max(): none is.
  [[nodiscard]] Time due() const { return asked_ ? asked_->repeat_at : Time::max(); }
  /// The one under way, which is due, once more. None: it was asked often enough, and its outcome
  /// is `unanswered`.
  std::optional<Question> repeat(Time now);
  /// REPLY has come. @return false: not to what is under way, but to what was asked twice.
  bool answer(std::uint8_t number, Status status);
  /// The session is over: so are all, in their order.
  void end();

  /// How often a question was repeated.
  [[nodiscard]] std::uint64_t retries() const { return retries_; }

 private:
  struct Asked {
    Request request;
    std::uint8_t number;
    unsigned tries;
    Time repeat_at;
  };

  Question write(Time now);
  void finish(const Reply& reply);

  std::optional<Asked> asked_;
  std::deque<Request> waiting_;
  std::uint8_t last_number_ = 0;
  std::uint64_t retries_ = 0;
};

}  // namespace serial
}  // namespace roio

#endif
