#include "listen/bus_words.hpp"

#include <algorithm>

namespace roio::cli {
namespace {

constexpr std::string_view digits = "0123456789";
constexpr std::string_view hex_digits = "0123456789abcdefABCDEF";

bool is_letter(char character) {
  return (character >= 'a' && character <= 'z') || (character >= 'A' && character <= 'Z');
}

bool is_name_character(char character) {
  return is_letter(character) || digits.find(character) != std::string_view::npos ||
         character == '_' || character == '-' || character == '.';
}

}  // namespace

bool looks_like_bus(std::string_view word) {
  if (word.starts_with("local:") || word.starts_with("serial:") || word.starts_with("socketcan:")) {
    return true;
  }
  return !word.empty() && is_letter(word.front()) &&
         digits.find(word.back()) != std::string_view::npos &&
         std::all_of(word.begin(), word.end(), is_name_character);
}

bool looks_like_filter(std::string_view word) {
  const std::size_t mask = word.find_first_of(":~");
  const bool has_mask =
      mask != std::string_view::npos && mask > 0 &&
      word.substr(0, mask).find_first_not_of(hex_digits) == std::string_view::npos;
  // A bus's options have "=", too.
  return !looks_like_bus(word) && (word.find('=') != std::string_view::npos || has_mask ||
                                   word == "urgent" || word == "normal" || word == "or");
}

BusWords split_bus_words(const std::vector<std::string>& named,
                         std::span<const std::string> words) {
  BusWords split{named, {}};
  if (named.empty() && !words.empty()) {
    split.buses.push_back(words.front());
    words = words.subspan(1);
  }
  const auto first_filter =
      std::find_if_not(words.begin(), words.end(), [](const auto& w) { return looks_like_bus(w); });
  split.buses.insert(split.buses.end(), words.begin(), first_filter);
  split.filters.assign(first_filter, words.end());
  return split;
}

}  // namespace roio::cli
