/// The words of `roio-cli bridge`.
#ifndef ROIO_CLI_BRIDGE_WORDS_HPP
#define ROIO_CLI_BRIDGE_WORDS_HPP

#include <CLI/CLI.hpp>
#include <string>

#include "program/command_line.hpp"

namespace roio::cli {

/// Declares the command and its own commands; lives until they have been parsed.
class BridgeWords {
 public:
  explicit BridgeWords(CLI::App& program);
  BridgeWords(const BridgeWords&) = delete;
  BridgeWords& operator=(const BridgeWords&) = delete;
  ~BridgeWords() = default;

  [[nodiscard]] bool parsed() const { return app_->parsed(); }
  /// @throws UsageError, as does the next: `bridge` was followed by a word that is no command.
  void refuse_unknown() const;
  [[nodiscard]] Command parse() const;

 private:
  CLI::App& declare(const char* name, const char* description, const char* usage,
                    const char* examples);
  [[nodiscard]] std::string port_of(const CLI::App& app) const;
  [[nodiscard]] BridgeShowOptions parse_show() const;
  [[nodiscard]] BridgeSetOptions parse_set() const;
  [[nodiscard]] BridgeIdentifyOptions parse_identify() const;
  [[nodiscard]] AttachOptions parse_attach() const;

  std::string port_, bitrate_text_, mode_text_, address_text_, seconds_text_ = "5", bus_;
  CLI::App* app_;
  CLI::App* show_;
  CLI::App* set_;
  CLI::App* identify_;
  CLI::App* attach_;
  CLI::Option* json_;
  CLI::Option* bitrate_;
  CLI::Option* mode_;
  CLI::Option* address_;
  CLI::Option* verbose_;
};

}  // namespace roio::cli

#endif
