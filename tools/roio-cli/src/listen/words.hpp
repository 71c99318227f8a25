/// The words that `dump` and `record` share: which buses, which frames, until when.
#ifndef ROIO_CLI_LISTEN_WORDS_HPP
#define ROIO_CLI_LISTEN_WORDS_HPP

#include <CLI/CLI.hpp>
#include <span>
#include <string>
#include <vector>

#include "listen/listener.hpp"
#include "names/option.hpp"

namespace roio::cli {

/// Declares them for a command; lives until its words have been parsed.
class ListenWords {
 public:
  explicit ListenWords(CLI::App& app);
  ListenWords(const ListenWords&) = delete;
  ListenWords& operator=(const ListenWords&) = delete;
  ~ListenWords() = default;

  /// The options alone: what is wrong with them is told before what is missing.
  /// @throws UsageError, as the other.
  [[nodiscard]] ListenOptions parse_options() const;
  void parse_words(ListenOptions& options) const;

 private:
  [[nodiscard]] std::vector<std::string> buses_named(const ListenOptions& options,
                                                     std::span<const std::string> words) const;

  std::string bus_, count_text_, quiet_text_;
  std::vector<std::string> named_, rest_;
  CLI::App& app_;
  RobotOption robot_;
  CLI::Option* count_;
  CLI::Option* quiet_;
  CLI::Option* no_foreign_;
  CLI::Option* errors_;
};

}  // namespace roio::cli

#endif
