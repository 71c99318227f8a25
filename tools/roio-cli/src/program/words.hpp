/// What the parsers of the commands' words share: how they declare options, read values, and
/// refuse.
#ifndef ROIO_CLI_WORDS_HPP
#define ROIO_CLI_WORDS_HPP

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <roio/text.hpp>
#include <string>

#include "program/exit_status.hpp"

namespace roio::cli {

/// @throws UsageError: what is wrong, and which help to read.
/// @param command "send", "bridge show"; empty for the program itself.
[[noreturn]] void refuse(const std::string& command, const std::string& what);

/// Refuses words that nothing was expected for: an option misspelt, one argument too many, an
/// unknown command. To be called before missing words are looked for, so that the misspelling is
/// what is named.
/// @param commands what could have stood there instead; none for a command without any of its own.
void refuse_rest(const CLI::App& app, const std::string& command, const char* commands = nullptr);

/// @throws UsageError, as all that follow.
std::uint64_t parse_number(const std::string& option, const std::string& text,
                           std::uint64_t smallest, std::uint64_t largest);
/// Up to a day.
std::chrono::milliseconds parse_ms(const std::string& option, const std::string& text,
                                   std::uint64_t smallest);
/// Of a bus, in bit/s.
std::uint32_t parse_bitrate(const std::string& text);
/// @return the text: the name of a bus, as open() takes it.
std::string parse_bus(const std::string& text);

template <typename T>
T value_or_refuse(const Parsed<T>& parsed, const char* option = "") {
  if (!parsed) {
    throw UsageError(option + parsed.error().message);
  }
  return *parsed;
}

CLI::Option* without_type(CLI::Option* option);
/// An option without a value.
CLI::Option* flag(CLI::App& app, const char* name, const char* description);
/// @param text where its value goes. @param value what help calls that.
CLI::Option* option(CLI::App& app, const char* name, std::string& text, const char* value,
                    const char* description);

/// Gives a command its help, and lets it take words that nothing was expected for, for
/// refuse_rest().
/// @param usage what follows "roio-cli " in its first line.
void prepare(CLI::App& app, const char* usage, const char* examples);

}  // namespace roio::cli

#endif
