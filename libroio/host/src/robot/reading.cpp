#include <algorithm>
#include <roio/kind.hpp>

#include "robot/exact.hpp"
#include "robot/value_rule.hpp"

namespace roio {
namespace {

std::int64_t take_bits(std::span<const std::uint8_t> data, const Field& field) {
  std::int64_t raw = 0;
  for (unsigned i = 0; i < field.width; ++i) {
    const unsigned at = field.first_bit + i;
    const unsigned bit = static_cast<unsigned>(data[at / 8]) >> (7U - at % 8) & 1U;
    raw = raw * 2 + bit;
  }
  const std::int64_t half = std::int64_t{1} << (field.width - 1U);
  const bool is_negative = field.form == Field::Form::signed_number && raw >= half;
  return is_negative ? raw - 2 * half : raw;
}

Reading take(std::span<const std::uint8_t> data, const Field& field) {
  Reading reading{&field};
  if (field.form != Field::Form::bytes) {
    reading.raw = take_bits(data, field);
    return reading;
  }
  const auto rest = data.subspan(field.first_bit / 8);
  std::copy(rest.begin(), rest.end(), reading.bytes.data.begin());
  reading.bytes.length = static_cast<std::uint8_t>(rest.size());
  reading.raw = reading.bytes.length;
  return reading;
}

}  // namespace

double Reading::value() const noexcept {
  return robot_file::step_value(raw, field->scale);
}

bool Reading::is_valid() const noexcept {
  if (field->form == Field::Form::choice) {
    return robot_file::find_choice(*field, raw) != nullptr;
  }
  return raw >= field->minimum && raw <= field->maximum;
}

std::string Reading::text() const {
  if (field->form == Field::Form::bytes) {
    return to_hex(bytes.data.data(), bytes.length);
  }
  const Choice* choice = robot_file::find_choice(*field, raw);
  return choice != nullptr ? choice->name : robot_file::step_text(raw, field->scale);
}

std::vector<Reading> unpack(const MessageKind& message, std::span<const std::uint8_t> data) {
  std::vector<Reading> readings;
  if (message.fits(data)) {
    for (const Field& field : message.fields) {
      readings.push_back(take(data, field));
    }
  }
  return readings;
}

}  // namespace roio
