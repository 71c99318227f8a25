/// LineRate: which line rate a session has: the best that both sides can do, tried out before it is
/// relied on, and a lower one once records are damaged often. Source:
/// docs/internals/serial-protocol.md "SPEED".
#ifndef ROIO_SERIAL_LINE_RATE_HPP
#define ROIO_SERIAL_LINE_RATE_HPP

#include <cstdint>
#include <optional>
#include <roio/serial_protocol.hpp>
#include <span>

namespace roio::serial {

/// No I/O and no time: the session says what has happened. Rates are in bit/s, and by their index
/// inside.
class LineRate {
 public:
  /// @param highest_bps the highest that may be used.
  explicit LineRate(std::uint32_t highest_bps) : highest_bps_(highest_bps) {}

  [[nodiscard]] std::uint32_t bps() const { return bps_of(rate_); }

  // --- when a session comes about ----------------------------------------------------------------

  /// Another port: nothing is known of the line.
  void begin();
  /// HELLO goes out at the base rate, whatever was before.
  void start_over();
  /// What WELCOME says. @param rates bit i: rate_bps(i). @param matters false: USB, no line.
  void offer(std::uint8_t rates, bool matters);

  // --- SPEED -------------------------------------------------------------------------------------

  /// The rate to ask for. None: there is no better one than the present.
  std::optional<std::uint32_t> ask();
  /// No reply came: the second time, that rate is not asked for again.
  void unanswered();
  void refused();
  /// The bridge has changed over: so does this side, and the trial begins.
  void try_out();

  // --- the trial ---------------------------------------------------------------------------------

  [[nodiscard]] bool is_missing(unsigned echo) const { return (missing_ >> echo & 1U) != 0; }
  enum class Trial : std::uint8_t { nonsense, going, passed, failed };
  /// An echo has come. @param payload what it has.
  Trial take(std::span<const std::uint8_t> payload);
  /// The present rate is too fast, so it is not asked for again.
  void give_up();

  // --- what comes --------------------------------------------------------------------------------

  void note_intact();
  /// A record has come to harm. @return false: it is the first thing at this rate, and so may be
  /// the garbage that the change of rate makes.
  bool note_damaged();
  /// A record has come to harm on its way down, as an intact one says.
  void note_damaged_down() { history_ |= 1U; }
  /// Limits ask() to lower rates when records are damaged often. @return whether it did.
  bool step_down_if_due();

 private:
  [[nodiscard]] static std::uint32_t bps_of(unsigned rate) {
    return rate_bps(static_cast<std::uint8_t>(rate));
  }
  [[nodiscard]] unsigned best() const;
  [[nodiscard]] int damaged_lately() const;
  void limit_below(unsigned rate) { limit_ = rate - (rate > 0 ? 1U : 0U); }

  std::uint32_t highest_bps_;
  std::uint8_t offered_ = 1;  // the base rate
  unsigned rate_ = 0;
  unsigned asked_ = 0;
  unsigned limit_ = rate_count - 1U;  // what has shown to be too fast is above
  unsigned unanswered_ = 0;
  std::uint32_t missing_ = 0;  // echoes, one bit each
  bool has_heard_ = true;      // something, at this rate
  std::uint64_t history_ = 0;  // of the last 64 records: 1 is damaged
};

}  // namespace roio::serial

#endif
