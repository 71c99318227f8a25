/// The words of `roio-cli ask`.
#ifndef ROIO_CLI_ASK_WORDS_HPP
#define ROIO_CLI_ASK_WORDS_HPP

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "ask/ask.hpp"
#include "names/option.hpp"

namespace roio::cli {

/// Declares the command; lives until its words have been parsed.
class AskWords {
 public:
  explicit AskWords(CLI::App& program);
  AskWords(const AskWords&) = delete;
  AskWords& operator=(const AskWords&) = delete;
  ~AskWords() = default;

  [[nodiscard]] bool parsed() const { return app_->parsed(); }
  /// @throws UsageError
  [[nodiscard]] AskOptions parse() const;

 private:
  std::string bus_, destination_, from_text_ = "0.10";
  std::string class_text_ = "message", timeout_text_ = "1000";
  std::vector<std::string> data_;
  CLI::App* app_;
  RobotOption robot_;
  CLI::Option* dec_;
  CLI::Option* urgent_;
  CLI::Option* json_;
};

}  // namespace roio::cli

#endif
