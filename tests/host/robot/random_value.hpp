#ifndef ROIO_TESTS_ROBOT_RANDOM_VALUE_HPP
#define ROIO_TESTS_ROBOT_RANDOM_VALUE_HPP

#include <random>
#include <roio/kind.hpp>

#include "seed.hpp"

namespace roio::test {

/// A value that the field holds, often at one of its ends.
inline Reading random_value(const Field& field, std::mt19937& random) {
  Reading reading{&field};
  const std::int64_t last = field.form == Field::Form::choice
                                ? static_cast<std::int64_t>(field.choices.size()) - 1
                                : field.maximum;
  const std::int64_t first = field.minimum;
  switch (up_to(random, 3)) {
    case 0:
      reading.raw = first;
      break;
    case 1:
      reading.raw = last;
      break;
    default:
      reading.raw = first + up_to(random, static_cast<std::uint32_t>(last - first));
  }
  if (field.form == Field::Form::bytes) {
    reading.bytes.length = static_cast<std::uint8_t>(reading.raw);
    for (unsigned i = 0; i < reading.bytes.length; ++i) {
      reading.bytes.data[i] = static_cast<std::uint8_t>(up_to(random, 255));
    }
  }
  return reading;
}

inline FieldValue value_of(const Reading& reading) {
  switch (reading.field->form) {
    case Field::Form::bytes:
      return reading.bytes;
    case Field::Form::choice:
      return reading.text();
    default:
      return reading.value();
  }
}

}  // namespace roio::test

#endif
