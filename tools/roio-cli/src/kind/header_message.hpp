/// One message of a kind in the C++ header: its names, its struct, its pack() and unpack().
#ifndef ROIO_CLI_KIND_HEADER_MESSAGE_HPP
#define ROIO_CLI_KIND_HEADER_MESSAGE_HPP

#include <roio/kind.hpp>
#include <string>
#include <vector>

#include "kind/names.hpp"

namespace roio::cli::header {

struct FieldNames {
  const Field* field;
  std::string member;
  std::string count_member;  ///< Of bytes whose number differs; else empty.
  std::string choice_type;   ///< Of a choice; else empty.
  std::vector<std::string> choices;
};

struct MessageNames {
  const MessageKind* message;
  std::string type;   ///< The struct: "Angles".
  std::string facts;  ///< The namespace of its constants: "angles".
  std::vector<FieldNames> fields;
};

/// What a direction's namespace has besides messages.
Scope direction_scope();

/// @param scope of its direction's namespace.
MessageNames names_of(const MessageKind& message, Scope& scope);

/// A whole number in C++11 that an int of 16 bits, an Arduino's, need not hold, and that compares
/// with variables of that sign.
std::string literal(std::int64_t value, bool is_signed);

/// "uint8_t", "int32_t", or the choice's type.
std::string type_of(const FieldNames& names);

/// The parts of an expression, as many in a line as there is room for.
/// @param indent of the lines after the first.
std::string filled(const std::vector<std::string>& parts, const std::string& separator,
                   const std::string& indent);

/// Every number is a choice.
inline constexpr const char* always = "true";

/// When a choice is one, as the one expression that a constexpr function of C++11 has.
std::string choice_check(const FieldNames& names);

std::string pack_function(const MessageNames& names);
std::string unpack_function(const MessageNames& names);

}  // namespace roio::cli::header

#endif
