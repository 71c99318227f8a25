/// The words of `roio-cli dump`.
#ifndef ROIO_CLI_DUMP_WORDS_HPP
#define ROIO_CLI_DUMP_WORDS_HPP

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "dump/dump.hpp"

namespace roio::cli {

/// Declares the command; lives until its words have been parsed.
class DumpWords {
 public:
  explicit DumpWords(CLI::App& program);
  DumpWords(const DumpWords&) = delete;
  DumpWords& operator=(const DumpWords&) = delete;
  ~DumpWords() = default;

  [[nodiscard]] bool parsed() const { return app_->parsed(); }
  /// @throws UsageError
  [[nodiscard]] DumpOptions parse() const;

 private:
  [[nodiscard]] DumpOptions parse_options() const;

  std::string bus_, count_text_, quiet_text_, time_text_;
  std::vector<std::string> filters_;
  CLI::App* app_;
  CLI::Option* count_;
  CLI::Option* quiet_;
  CLI::Option* time_;
  CLI::Option* log_;
  CLI::Option* json_;
  CLI::Option* no_foreign_;
  CLI::Option* errors_;
  CLI::Option* verbose_;
};

}  // namespace roio::cli

#endif
