#ifndef ROIO_ROBOT_ALIKE_HPP
#define ROIO_ROBOT_ALIKE_HPP

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace roio::robot_file {

/// The name that may have been meant: begun and not ended ("max"), or a slip of the pen away (a
/// letter more, less, another, two swapped, upper for lower case), in a third of its letters at
/// most. Of several the nearest.
std::optional<std::string> nearest(std::string_view word, const std::vector<std::string>& names);

/// "a, b, c", of many the first ten and how many more.
std::string listed(const std::vector<std::string>& names);

/// What follows an unknown name: "did you mean "angles"?", or "expected one of ..." when none is
/// near, or `none` when there are none.
std::string advice(std::string_view word, const std::vector<std::string>& names,
                   const std::string& none);

}  // namespace roio::robot_file

#endif
