/// The words of `roio-cli hub`.
#ifndef ROIO_CLI_HUB_WORDS_HPP
#define ROIO_CLI_HUB_WORDS_HPP

#include <CLI/CLI.hpp>
#include <string>

#include "buses/hub.hpp"

namespace roio::cli {

/// Declares the command; lives until its words have been parsed.
class HubWords {
 public:
  explicit HubWords(CLI::App& program);
  HubWords(const HubWords&) = delete;
  HubWords& operator=(const HubWords&) = delete;
  ~HubWords() = default;

  [[nodiscard]] bool parsed() const { return app_->parsed(); }
  /// @throws UsageError
  [[nodiscard]] HubOptions parse() const;

 private:
  std::string name_, bitrate_text_;
  CLI::App* app_;
  CLI::Option* bitrate_;
};

}  // namespace roio::cli

#endif
