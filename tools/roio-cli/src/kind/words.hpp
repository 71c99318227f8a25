/// The words of `roio-cli kind` and `roio-cli robot`.
#ifndef ROIO_CLI_KIND_WORDS_HPP
#define ROIO_CLI_KIND_WORDS_HPP

#include <CLI/CLI.hpp>
#include <string>

#include "program/command_line.hpp"

namespace roio::cli {

/// -o and --check, which all have that make a file.
class TargetWords {
 public:
  void declare(CLI::App& app);
  /// @throws UsageError: --check without -o.
  [[nodiscard]] Target parse(const CLI::App& app) const;

 private:
  std::string output_;
};

/// Declares the command and its own commands; lives until they have been parsed.
class KindWords {
 public:
  explicit KindWords(CLI::App& program);
  KindWords(const KindWords&) = delete;
  KindWords& operator=(const KindWords&) = delete;
  ~KindWords() = default;

  [[nodiscard]] bool parsed() const { return app_->parsed(); }
  /// @throws UsageError, as does the next: `kind` was followed by a word that is no command.
  void refuse_unknown() const;
  [[nodiscard]] Command parse() const;

 private:
  CLI::App& declare(const char* name, const char* description, const char* usage,
                    const char* examples);

  std::string file_;
  TargetWords target_;
  CLI::App* app_;
  CLI::App* header_;
  CLI::App* js_;
  CLI::App* md_;
};

/// The same of `robot`.
class RobotWords {
 public:
  explicit RobotWords(CLI::App& program);
  RobotWords(const RobotWords&) = delete;
  RobotWords& operator=(const RobotWords&) = delete;
  ~RobotWords() = default;

  [[nodiscard]] bool parsed() const { return app_->parsed(); }
  void refuse_unknown() const;
  [[nodiscard]] Command parse() const;

 private:
  std::string file_;
  TargetWords target_;
  CLI::App* app_;
  CLI::App* dbc_;
  CLI::App* check_;
};

}  // namespace roio::cli

#endif
