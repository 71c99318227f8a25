/// Kinds at random, with all that the format allows and names that mean something elsewhere.
#ifndef ROIO_TEST_RANDOM_KIND_HPP
#define ROIO_TEST_RANDOM_KIND_HPP

#include <cstdint>
#include <random>
#include <roio/kind.hpp>
#include <string>
#include <vector>

namespace roio::test {

/// The text of a kind's file.
std::string random_kind_text(std::mt19937& random, const std::string& name);

/// What is to be put into a message, and what goes on the wire for it.
struct Vector {
  std::vector<NamedValue> values;
  std::vector<std::int64_t> raw;  ///< Of each field; of bytes their number.
  Parsed<Bytes> packed;           ///< As roio::pack() does it; an error: it refuses them.
};

/// Values at the ends of their ranges, in them, between two steps, and a little out of them.
Vector random_vector(std::mt19937& random, const MessageKind& message);

/// Bytes that may be such a message: mostly with its length and tag, and values of all kinds.
Bytes random_bytes(std::mt19937& random, const MessageKind& message);

}  // namespace roio::test

#endif
