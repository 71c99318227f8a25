/// The words of `roio-cli top`.
#ifndef ROIO_CLI_TOP_WORDS_HPP
#define ROIO_CLI_TOP_WORDS_HPP

#include <CLI/CLI.hpp>
#include <string>

#include "names/option.hpp"
#include "top/top.hpp"

namespace roio::cli {

/// Declares the command; lives until its words have been parsed.
class TopWords {
 public:
  explicit TopWords(CLI::App& program);
  TopWords(const TopWords&) = delete;
  TopWords& operator=(const TopWords&) = delete;
  ~TopWords() = default;

  [[nodiscard]] bool parsed() const { return app_->parsed(); }
  /// @throws UsageError
  [[nodiscard]] TopOptions parse() const;

 private:
  std::string bus_, bitrate_text_, interval_text_, count_text_;
  CLI::App* app_;
  RobotOption robot_;
  CLI::Option* bitrate_;
  CLI::Option* interval_;
  CLI::Option* count_;
  CLI::Option* json_;
};

}  // namespace roio::cli

#endif
