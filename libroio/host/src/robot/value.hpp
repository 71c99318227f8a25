#ifndef ROIO_ROBOT_VALUE_HPP
#define ROIO_ROBOT_VALUE_HPP

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace roio::robot_file {

/// A value of a JSON document, as it was written: what it is worth is asked for later, and where it
/// stands is known until then.
struct Value {
  enum class Type : std::uint8_t { null, boolean, number, text, array, object };

  std::string name;        ///< In an object.
  std::size_t offset = 0;  ///< Where it begins, in bytes; in an object, where its name does.
  Type type = Type::null;
  std::string text;             ///< Of a text; of a number and a boolean as written.
  std::vector<Value> children;  ///< Of an array or an object, in their order.
};

}  // namespace roio::robot_file

#endif
