#ifndef ROIO_ROBOT_FIELD_READER_HPP
#define ROIO_ROBOT_FIELD_READER_HPP

#include <roio/kind.hpp>
#include <vector>

#include "robot/at.hpp"

namespace roio::robot_file {

/// Lays fields out, one behind the other, from the highest bit of a message on.
class Layout {
 public:
  /// @param first_bit behind the tag.
  explicit Layout(unsigned first_bit) : next_bit_(first_bit) {}

  /// Where a field of so many bits is: one of less than 8 in the byte of those before it, if there
  /// is room; any other at the start of a byte.
  /// @return its first bit.
  unsigned place(unsigned width);
  /// For a field that begins at the next byte and takes all that is left.
  [[nodiscard]] unsigned bytes_left() const;
  [[nodiscard]] unsigned bytes() const { return (next_bit_ + 7) / 8; }

 private:
  unsigned next_bit_;
};

/// The fields of a message, at their bits. @throws Refused
std::vector<Field> read_message_fields(const At& array, Layout& layout);
/// Those that a robot sets, which are on no wire. @throws Refused
std::vector<Field> read_settings(const At& array);

}  // namespace roio::robot_file

#endif
