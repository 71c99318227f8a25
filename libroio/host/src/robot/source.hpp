#ifndef ROIO_ROBOT_SOURCE_HPP
#define ROIO_ROBOT_SOURCE_HPP

#include <cstddef>
#include <roio/text.hpp>
#include <stdexcept>
#include <string>
#include <string_view>

namespace roio::robot_file {

/// Why a text was not read. Thrown inside this wing, from any depth of a document, and caught where
/// the wing is entered: nobody outside sees it.
class Refused : public std::runtime_error {
 public:
  explicit Refused(const ParseError& error)
      : std::runtime_error(error.message), offset_(error.offset) {}
  [[nodiscard]] ParseError error() const { return {what(), offset_}; }

 private:
  std::size_t offset_;
};

/// A text, and what errors call it. Both outlive it.
class Source {
 public:
  Source(std::string_view text, std::string_view origin) : text_(text), origin_(origin) {}

  [[nodiscard]] std::string_view text() const { return text_; }
  /// "arm.kind.json:7: places.arm: " and what is wrong; without a place for the whole of it.
  /// @param offset in bytes from the start of the text; behind its end counts as its end.
  [[nodiscard]] ParseError error(std::size_t offset, std::string_view place,
                                 const std::string& what) const;
  [[noreturn]] void refuse(std::size_t offset, std::string_view place,
                           const std::string& what) const {
    throw Refused(error(offset, place, what));
  }
  /// Of the whole file, without a line.
  [[noreturn]] void refuse(const std::string& what) const;

 private:
  std::string_view text_;
  std::string_view origin_;
};

/// A file's name as errors show it: as it is, or quoted when it would not fit in a line.
std::string shown_name(std::string_view file);

/// Refuses what is no text of a document: too long, not UTF-8, with a zero byte, or with a byte
/// order mark.
void check_text(const Source& source);

}  // namespace roio::robot_file

#endif
