/// The words of `roio-cli record`.
#ifndef ROIO_CLI_RECORD_WORDS_HPP
#define ROIO_CLI_RECORD_WORDS_HPP

#include <CLI/CLI.hpp>
#include <string>

#include "listen/words.hpp"
#include "record/record.hpp"

namespace roio::cli {

/// Declares the command; lives until its words have been parsed.
class RecordWords {
 public:
  explicit RecordWords(CLI::App& program);
  RecordWords(const RecordWords&) = delete;
  RecordWords& operator=(const RecordWords&) = delete;
  ~RecordWords() = default;

  [[nodiscard]] bool parsed() const { return app_->parsed(); }
  /// @throws UsageError
  [[nodiscard]] RecordOptions parse() const;

 private:
  [[nodiscard]] RecordOptions parse_options() const;
  [[nodiscard]] Form parse_form() const;

  std::string file_text_;
  CLI::App* app_;
  CLI::Option* file_;
  CLI::Option* force_;
  CLI::Option* csv_;
  CLI::Option* pcap_;
  ListenWords listen_;
};

}  // namespace roio::cli

#endif
