/// The words of `roio-cli attach`.
#ifndef ROIO_CLI_ATTACH_WORDS_HPP
#define ROIO_CLI_ATTACH_WORDS_HPP

#include <CLI/CLI.hpp>
#include <string>

#include "attach/attach.hpp"

namespace roio::cli {

/// Declares the command; lives until its words have been parsed.
class AttachWords {
 public:
  explicit AttachWords(CLI::App& program);
  AttachWords(const AttachWords&) = delete;
  AttachWords& operator=(const AttachWords&) = delete;
  ~AttachWords() = default;

  [[nodiscard]] bool parsed() const { return app_->parsed(); }
  /// @throws UsageError
  [[nodiscard]] AttachOptions parse() const;

 private:
  std::string first_, second_;
  CLI::App* app_;
  CLI::Option* verbose_;
};

}  // namespace roio::cli

#endif
