/// The words of a message that `send` and `ask` have in common.
#ifndef ROIO_CLI_MESSAGE_WORDS_HPP
#define ROIO_CLI_MESSAGE_WORDS_HPP

#include <roio/header.hpp>
#include <roio/robot.hpp>
#include <roio/text.hpp>
#include <span>
#include <string>
#include <vector>

namespace roio::cli {

/// The words that are no options: [BUS] DEST [DATA...].
struct MessageWords {
  std::string bus;
  std::string destination;
  std::vector<std::string> data;
};

/// BUS may be left out where the robot names one: then the first word says where to.
/// @param robot null: there is none.
/// @throws UsageError, as those that follow: BUS is left out, and what stands for DEST is none.
MessageWords sort_words(const Robot* robot, const MessageWords& words);

/// Whether a word is an ID#DATA.
bool is_frame(const std::string& destination);

/// DATA: hexadecimal, in one word or in several, as dump prints them; or decimal, a word a byte.
Bytes parse_data_words(std::span<const std::string> words, bool decimal);

/// DATA by the names that the message has on its way, else as bytes.
/// @param header its addresses and class are what it is looked up by.
Bytes parse_data(const Robot* robot, const Header& header, std::span<const std::string> words,
                 bool decimal);

/// The value of --class.
MessageClass parse_sendable_class(const std::string& text);

}  // namespace roio::cli

#endif
