/// Which of a command's words are buses, and which are filters. Pure functions.
#ifndef ROIO_CLI_BUS_WORDS_HPP
#define ROIO_CLI_BUS_WORDS_HPP

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace roio::cli {

struct BusWords {
  std::vector<std::string> buses;
  std::vector<std::string> filters;
};

/// Whether a word that may be a filter is a bus instead: it begins with "local:", "serial:" or
/// "socketcan:", or is an interface's name as they mostly are, letters and then a number ("can0",
/// "vcan12"). No filter is either.
bool looks_like_bus(std::string_view word);

/// Whether a word can be nothing but a filter: it is no bus by its look, and has "=", or is
/// "urgent", "normal" or "or", or ID:MASK or ID~MASK.
bool looks_like_filter(std::string_view word);

/// @param named buses that an option has named, so that no other word has to be one.
/// @param words the first is a bus, whatever it looks like, unless some are named; those after it
///        are buses as long as they look like one; the rest are filters.
BusWords split_bus_words(const std::vector<std::string>& named, std::span<const std::string> words);

}  // namespace roio::cli

#endif
