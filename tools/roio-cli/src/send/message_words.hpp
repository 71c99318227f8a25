/// The words of a message that `send` and `ask` have in common.
#ifndef ROIO_CLI_MESSAGE_WORDS_HPP
#define ROIO_CLI_MESSAGE_WORDS_HPP

#include <roio/header.hpp>
#include <roio/text.hpp>
#include <span>
#include <string>

namespace roio::cli {

/// DATA: hexadecimal, in one word or in several, as dump prints them; or decimal, a word a byte.
/// @throws UsageError, as the next does.
Bytes parse_data_words(std::span<const std::string> words, bool decimal);

/// The value of --class.
MessageClass parse_sendable_class(const std::string& text);

}  // namespace roio::cli

#endif
