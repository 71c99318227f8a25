/// Status: what a call of the core or of the firmware came to. Where a caller cannot be told (an
/// interrupt, a frame nobody asked for), a counter takes its place.
#ifndef ROIO_STATUS_HPP
#define ROIO_STATUS_HPP

#include <stdint.h>

/// Marks a function whose result must be looked at; the same for C++11 on AVR and C++20 on the
/// host.
#if defined(__cplusplus) && __cplusplus >= 201703L
#define ROIO_NODISCARD [[nodiscard]]
#elif defined(__GNUC__)
#define ROIO_NODISCARD __attribute__((warn_unused_result))
#else
#define ROIO_NODISCARD
#endif

namespace roio {

enum class Status : uint8_t {
  ok = 0,
  bad_argument,   ///< A field is outside its range; nothing was done.
  full,           ///< No room left; nothing was stored. Try again later, or with more room.
  not_roio,       ///< Not an extended data frame, so never a Roio message.
  unknown_class,  ///< A Roio frame of a class that this version does not know.
  empty,          ///< Nothing has come in.
  no_chip,        ///< The controller does not answer, or answers what it cannot have been told.
  wrong_mode,     ///< The controller answers and does not enter the mode that it was asked for.
  bad_timing,     ///< The bit timing breaks the controller's rules; no controller was touched.
  wrong_clock,    ///< The controller's oscillator is not the one that the bit timing is for.
};

/// The texts of to_string(), one behind the other, each with a NUL at its end: where flash is not
/// read like RAM, they are put there from this.
#define ROIO_STATUS_TEXTS                                                                \
  "ok\0bad argument\0full\0not a Roio frame\0unknown class\0nothing received\0"          \
  "no controller answers\0controller not in the mode asked for\0impossible bit timing\0" \
  "controller runs at another clock\0unknown status"

namespace detail {
constexpr char status_texts[] = ROIO_STATUS_TEXTS;
constexpr const char* behind(const char* text) {
  return *text == '\0' ? text + 1 : behind(text + 1);
}
constexpr const char* nth_text(const char* first, uint8_t n) {
  return n == 0 ? first : nth_text(behind(first), static_cast<uint8_t>(n - 1U));
}
static_assert(nth_text(status_texts, static_cast<uint8_t>(Status::wrong_clock) + 1U) -
                      status_texts + sizeof "unknown status" ==
                  sizeof status_texts,
              "one text for each status, and one for what is none");
}  // namespace detail

/// Which of ROIO_STATUS_TEXTS.
constexpr uint8_t text_number(Status status) {
  return static_cast<uint8_t>(status <= Status::wrong_clock
                                  ? static_cast<uint8_t>(status)
                                  : static_cast<uint8_t>(Status::wrong_clock) + 1U);
}

/// A short lower-case phrase, for logs and messages; never null.
constexpr const char* to_string(Status status) {
  return detail::nth_text(detail::status_texts, text_number(status));
}

}  // namespace roio

#endif
