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

namespace detail {
constexpr const char* status_texts[] = {"ok",
                                        "bad argument",
                                        "full",
                                        "not a Roio frame",
                                        "unknown class",
                                        "nothing received",
                                        "no controller answers",
                                        "controller not in the mode asked for",
                                        "impossible bit timing",
                                        "controller runs at another clock"};
static_assert(sizeof status_texts / sizeof status_texts[0] ==
                  static_cast<uint8_t>(Status::wrong_clock) + 1U,
              "one text for each status");
}  // namespace detail

/// A short lower-case phrase, for logs and messages; never null.
constexpr const char* to_string(Status status) {
  return status <= Status::wrong_clock ? detail::status_texts[static_cast<uint8_t>(status)]
                                       : "unknown status";
}

}  // namespace roio

#endif
