/// The words of `roio-cli dump`.
#ifndef ROIO_CLI_DUMP_WORDS_HPP
#define ROIO_CLI_DUMP_WORDS_HPP

#include <CLI/CLI.hpp>
#include <string>

#include "dump/dump.hpp"
#include "listen/words.hpp"

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
  [[nodiscard]] Form parse_form() const;

  std::string time_text_;
  CLI::App* app_;
  ListenWords listen_;
  CLI::Option* time_;
  CLI::Option* log_;
  CLI::Option* json_;
  CLI::Option* csv_;
  CLI::Option* pcap_;
  CLI::Option* colour_;
  CLI::Option* bytes_only_;
  CLI::Option* verbose_;
};

}  // namespace roio::cli

#endif
