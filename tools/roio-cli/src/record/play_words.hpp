/// The words of `roio-cli play`.
#ifndef ROIO_CLI_PLAY_WORDS_HPP
#define ROIO_CLI_PLAY_WORDS_HPP

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "record/play.hpp"

namespace roio::cli {

/// Declares the command; lives until its words have been parsed.
class PlayWords {
 public:
  explicit PlayWords(CLI::App& program);
  PlayWords(const PlayWords&) = delete;
  PlayWords& operator=(const PlayWords&) = delete;
  ~PlayWords() = default;

  [[nodiscard]] bool parsed() const { return app_->parsed(); }
  /// @throws UsageError
  [[nodiscard]] PlayOptions parse() const;

 private:
  [[nodiscard]] PlayOptions parse_options() const;
  [[nodiscard]] PlayPace parse_pace() const;

  std::string speed_text_, loop_text_, from_text_, to_text_, gap_text_, file_;
  std::string timeout_text_ = "1000", wait_text_;
  std::vector<std::string> buses_;
  CLI::App* app_;
  CLI::Option* speed_;
  CLI::Option* gap_;
  CLI::Option* from_;
  CLI::Option* to_;
  CLI::Option* loop_;
  CLI::Option* wait_;
};

}  // namespace roio::cli

#endif
