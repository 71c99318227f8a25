/// The words of `roio-cli send`.
#ifndef ROIO_CLI_SEND_WORDS_HPP
#define ROIO_CLI_SEND_WORDS_HPP

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "names/option.hpp"
#include "send/message_words.hpp"
#include "send/send.hpp"

namespace roio::cli {

/// Declares the command; lives until its words have been parsed.
class SendWords {
 public:
  explicit SendWords(CLI::App& program);
  SendWords(const SendWords&) = delete;
  SendWords& operator=(const SendWords&) = delete;
  ~SendWords() = default;

  [[nodiscard]] bool parsed() const { return app_->parsed(); }
  /// @throws UsageError
  [[nodiscard]] SendOptions parse() const;

 private:
  [[nodiscard]] SendOptions parse_options(const Robot* robot) const;
  [[nodiscard]] Frame parse_message(const MessageWords& said, const SendOptions& options) const;
  [[nodiscard]] Frame parse_frame(const MessageWords& said) const;
  void refuse_with(const MessageWords& said, const char* what, const char* who,
                   bool count_too) const;

  std::string bus_, destination_, from_text_;
  std::string class_text_ = "message";
  std::string count_text_ = "1", interval_text_ = "0", timeout_text_ = "1000", wait_text_;
  std::vector<std::string> data_;
  CLI::App* app_;
  RobotOption robot_;
  CLI::Option* dec_;
  CLI::Option* from_;
  CLI::Option* urgent_;
  CLI::Option* message_class_;
  CLI::Option* count_;
  CLI::Option* interval_;
  CLI::Option* wait_;
};

}  // namespace roio::cli

#endif
