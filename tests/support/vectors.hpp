/// The worked examples of docs/protocol.md, read from the document itself.
#ifndef ROIO_TESTS_VECTORS_HPP
#define ROIO_TESTS_VECTORS_HPP

#include <array>
#include <cstdint>
#include <ostream>
#include <roio/message.hpp>
#include <string>
#include <vector>

namespace roio::test {

struct Vector {
  std::string name;
  int line;  ///< In the document, from 1.
  Message message;
  std::uint32_t id;
  std::string text;
  std::uint8_t bits;
  std::uint16_t crc;
  std::array<std::uint8_t, 4> registers;  ///< SIDH, SIDL with EXIDE, EID8, EID0.
};

/// What a failing test prints.
inline std::ostream& operator<<(std::ostream& out, const Vector& vector) {
  return out << vector.name << " (line " << vector.line << ')';
}

/// @throws std::runtime_error naming the line that is no example, or when there is no table.
std::vector<Vector> read_vectors(const std::string& path);

}  // namespace roio::test

#endif
