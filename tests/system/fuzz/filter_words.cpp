#include "listen/filter_words.hpp"

#include <string>
#include <vector>

#include "target.hpp"

namespace roio::fuzz {
namespace {

// A space ends a word, so that words may be empty and hold anything else.
std::vector<std::string> split(std::string_view text) {
  std::vector<std::string> words;
  while (!text.empty()) {
    const std::size_t end = text.find(' ');
    words.emplace_back(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return words;
}

}  // namespace

void check(std::string_view text) {
  for (const bool roio_only : {false, true}) {
    const auto filters = cli::compile_filter_words(split(text), roio_only);
    if (!filters) {
      require_good_error(filters.error(), text);
      continue;
    }
    require(!filters->empty() && filters->size() <= cli::max_kernel_filters, "1..512 filters");
    for (const SocketCanFilter& filter : *filters) {
      require((filter.can_mask & socketcan::error_flag) == 0, "bit 29 of a mask is 0");
      require((filter.can_id & ~filter.can_mask & ~socketcan::inverted) == 0,
              "an identifier lies within its mask");
    }
  }
}

}  // namespace roio::fuzz
