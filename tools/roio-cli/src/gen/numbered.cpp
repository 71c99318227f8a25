#include "gen/numbered.hpp"

#include <algorithm>

namespace roio::cli {
namespace {

constexpr std::size_t number_at = 2;
constexpr std::size_t longest_number = 4;
constexpr unsigned roams_bit = 0x80;

std::uint8_t crc8(std::uint8_t crc, std::uint8_t byte) {
  constexpr unsigned polynomial = 0x2F;  // x8+x5+x3+x2+x+1, AUTOSAR's: 3 bits in 8 bytes are found
  unsigned rest = crc ^ byte;
  for (int bit = 0; bit < 8; ++bit) {
    rest = (rest & 0x80U) != 0 ? (rest << 1) ^ polynomial : rest << 1;
  }
  return static_cast<std::uint8_t>(rest);
}

// The length goes in, too: a message that was cut off is none.
std::uint8_t check_of(std::span<const std::uint8_t> data) {
  std::uint8_t crc = crc8(0xFF, static_cast<std::uint8_t>(data.size()));
  for (std::size_t i = 0; i < data.size(); ++i) {
    crc = i == 1 ? crc : crc8(crc, data[i]);
  }
  return crc;
}

std::size_t number_bytes(std::size_t length) {
  return std::min(length - number_at, longest_number);
}

void fill(std::span<std::uint8_t> data, std::size_t from, std::uint32_t number) {
  // Knuth's multiplier scatters neighbouring numbers.
  const std::uint32_t filler = (number ^ (std::uint32_t{data[0]} << 24)) * 2654435761U;
  for (std::size_t i = from; i < data.size(); ++i) {
    data[i] = static_cast<std::uint8_t>(filler >> (24 - 8 * (i - from)));
  }
}

}  // namespace

std::array<std::uint8_t, max_data_length> write_numbered(Generator generator, std::uint32_t number,
                                                         std::uint8_t length) {
  std::array<std::uint8_t, max_data_length> data{};
  data[0] = static_cast<std::uint8_t>(generator.id | (generator.roams ? roams_bit : 0U));
  const std::size_t bytes = number_bytes(length);
  for (std::size_t i = 0; i < bytes; ++i) {
    data[number_at + i] = static_cast<std::uint8_t>(number >> (8 * (bytes - 1 - i)));
  }
  const std::span used = std::span(data).first(length);
  fill(used, number_at + bytes, number);
  data[1] = check_of(used);
  return data;
}

std::optional<Numbered> read_numbered(std::span<const std::uint8_t> data) {
  if (data.size() < shortest_numbered || data.size() > max_data_length) {
    return std::nullopt;
  }
  Numbered numbered;
  numbered.generator = {static_cast<std::uint8_t>(data[0] & ~roams_bit),
                        (data[0] & roams_bit) != 0};
  const std::size_t bytes = number_bytes(data.size());
  for (const std::uint8_t byte : data.subspan(number_at, bytes)) {
    numbered.number = numbered.number << 8 | byte;
  }
  numbered.bits = static_cast<std::uint8_t>(8 * bytes);
  // Check and filler are those that a generator makes.
  const auto expected =
      write_numbered(numbered.generator, numbered.number, static_cast<std::uint8_t>(data.size()));
  return std::equal(data.begin(), data.end(), expected.begin()) ? std::optional(numbered)
                                                                : std::nullopt;
}

}  // namespace roio::cli
