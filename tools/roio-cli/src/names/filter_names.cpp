#include "names/filter_names.hpp"

#include <string_view>

#include "names/robot.hpp"
#include "program/exit_status.hpp"

namespace roio::cli {
namespace {

// Names begin with a letter, and what a filter takes beside them with a digit.
bool is_name(std::string_view text) {
  return !text.empty() && (text.front() < '0' || text.front() > '9');
}

std::string with_address(const Robot& robot, const std::string& word) {
  for (const std::string_view key : {"to=", "from="}) {
    if (word.starts_with(key) && is_name(std::string_view(word).substr(key.size()))) {
      const auto address = address_of(&robot, word.substr(key.size()));
      if (!address) {
        throw UsageError(std::string(key) + " " + address.error().message);
      }
      return std::string(key) + to_string(*address);
    }
  }
  return word;
}

}  // namespace

std::vector<std::string> with_addresses(const Robot* robot, std::vector<std::string> words) {
  if (robot != nullptr) {
    for (std::string& word : words) {
      word = with_address(*robot, word);
    }
  }
  return words;
}

}  // namespace roio::cli
