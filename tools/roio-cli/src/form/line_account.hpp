/// What became of the lines of an input: which were refused, and what was passed over.
#ifndef ROIO_CLI_LINE_ACCOUNT_HPP
#define ROIO_CLI_LINE_ACCOUNT_HPP

#include <cstdint>
#include <roio/text.hpp>
#include <string>

#include "form/input_line.hpp"

namespace roio::cli {

class LineAccount {
 public:
  /// @param input named before each line that is told of: "drive.log"; empty for standard input.
  explicit LineAccount(std::string input = {}) : input_(std::move(input)) {}

  void next_line() { ++line_number_; }

  /// Counts it, and names the line it is in, if there have not been too many.
  void refuse(const ParseError& error);
  /// Counts what is no frame.
  void pass_over(InputLine::Kind kind);
  /// One line on standard error, with the number of the line.
  void tell(const std::string& what) const;

  [[nodiscard]] std::uint64_t refused() const { return refused_; }
  [[nodiscard]] bool is_plain() const { return refused_ == 0 && news_ == 0 && comments_ == 0; }
  /// ", 2 lines refused, passed over: 1 bus report, 3 comments"; empty when it is plain.
  [[nodiscard]] std::string text() const;

 private:
  std::string input_;
  std::uint64_t line_number_ = 0;
  std::uint64_t refused_ = 0;
  std::uint64_t news_ = 0;
  std::uint64_t comments_ = 0;
};

}  // namespace roio::cli

#endif
