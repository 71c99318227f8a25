#include "robot/alike.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <roio/text.hpp>

namespace roio::robot_file {
namespace {

constexpr std::size_t longest = 64;  // what is longer is no slip of the pen
constexpr std::size_t most_listed = 10;

using Row = std::array<std::size_t, longest + 1>;

char lower(char character) {
  return character >= 'A' && character <= 'Z' ? static_cast<char>(character - 'A' + 'a')
                                              : character;
}

bool are_swapped(std::string_view a, std::size_t i, std::string_view b, std::size_t j) {
  return i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]);
}

/// How many letters are more, less, another, or swapped with the next (optimal string alignment).
std::size_t distance(std::string_view a, std::string_view b) {
  Row before_last{};
  Row last{};
  for (std::size_t j = 0; j <= b.size(); ++j) {
    last[j] = j;
  }
  for (std::size_t i = 1; i <= a.size(); ++i) {
    Row row{};
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t other = lower(a[i - 1]) == lower(b[j - 1]) ? 0 : 1;
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + other});
      if (are_swapped(a, i, b, j)) {
        row[j] = std::min(row[j], before_last[j - 2] + 1);
      }
    }
    before_last = last;
    last = row;
  }
  return last[b.size()];
}

bool is_short_for(std::string_view word, std::string_view name) {
  constexpr std::size_t least = 3;
  return word.size() >= least && name.starts_with(word);
}

}  // namespace

std::optional<std::string> nearest(std::string_view word, const std::vector<std::string>& names) {
  std::optional<std::string> found;
  std::size_t least = 0;
  for (const std::string& name : names) {
    if (word.empty() || word.size() > longest || name.size() > longest) {
      continue;
    }
    const std::size_t steps = is_short_for(word, name) ? 1 : distance(word, name);
    const std::size_t most = std::max<std::size_t>(1, std::min(word.size(), name.size()) / 3);
    if (steps <= most && steps < name.size() && (!found || steps < least)) {
      found = name;
      least = steps;
    }
  }
  return found;
}

std::string listed(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t i = 0; i < names.size() && i < most_listed; ++i) {
    out += (i == 0 ? "" : ", ") + names[i];
  }
  if (names.size() > most_listed) {
    out += " and " + std::to_string(names.size() - most_listed) + " more";
  }
  return out;
}

std::string advice(std::string_view word, const std::vector<std::string>& names,
                   const std::string& none) {
  if (names.empty()) {
    return none;
  }
  if (const auto name = nearest(word, names)) {
    return "did you mean " + quote(*name) + '?';
  }
  return (names.size() == 1 ? "expected " : "expected one of ") + listed(names);
}

}  // namespace roio::robot_file
