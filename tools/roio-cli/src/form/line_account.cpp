#include "form/line_account.hpp"

#include <utility>

#include "form/record_format.hpp"
#include "program/output.hpp"

namespace roio::cli {
namespace {

// So many lines are named one by one; who gives what is no log at all wants no more of them.
constexpr std::uint64_t max_named_lines = 10;

}  // namespace

void LineAccount::refuse(const ParseError& error) {
  ++refused_;
  if (refused_ <= max_named_lines) {
    tell(": " + error.message);
  } else if (refused_ == max_named_lines + 1) {
    tell(" and others, which are not named: their number follows at the end");
  }
}

void LineAccount::pass_over(InputLine::Kind kind) {
  (kind == InputLine::Kind::news ? news_ : comments_) += 1;
}

void LineAccount::tell(const std::string& what) const {
  note((input_.empty() ? "" : input_ + ": ") + "line " + std::to_string(line_number_) + what);
}

std::string LineAccount::text() const {
  std::string text = refused_ > 0 ? ", " + count_of(refused_, "line") + " refused" : "";
  const char* separator = ", passed over: ";
  for (const auto& [count, what] :
       {std::pair{news_, "bus report"}, std::pair{comments_, "comment"}}) {
    if (count > 0) {
      text += separator + count_of(count, what);
      separator = ", ";
    }
  }
  return text;
}

}  // namespace roio::cli
