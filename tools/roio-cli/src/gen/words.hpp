/// The words of `roio-cli gen`.
#ifndef ROIO_CLI_GEN_WORDS_HPP
#define ROIO_CLI_GEN_WORDS_HPP

#include <CLI/CLI.hpp>
#include <string>
#include <variant>
#include <vector>

#include "gen/check.hpp"
#include "gen/gen.hpp"
#include "names/option.hpp"

namespace roio::cli {

/// Declares the command; lives until its words have been parsed.
class GenWords {
 public:
  explicit GenWords(CLI::App& program);
  GenWords(const GenWords&) = delete;
  GenWords& operator=(const GenWords&) = delete;
  ~GenWords() = default;

  [[nodiscard]] bool parsed() const { return app_->parsed(); }
  /// @throws UsageError
  [[nodiscard]] std::variant<GenOptions, CheckOptions> parse() const;

 private:
  [[nodiscard]] GenOptions parse_gen(const Robot* robot) const;
  [[nodiscard]] CheckOptions parse_check(const Robot* robot) const;
  [[nodiscard]] TrafficOptions parse_traffic(const Robot* robot) const;
  void parse_speed(GenOptions& options) const;

  std::string bus_, load_text_, rate_text_, bitrate_text_, size_text_ = "8";
  std::string from_text_ = "0.10", to_text_ = "30.254", id_text_, seed_text_;
  std::string count_text_, time_text_, quiet_text_, timeout_text_ = "1000";
  CLI::App* app_;
  RobotOption robot_;
  CLI::Option* check_;
  CLI::Option* load_;
  CLI::Option* rate_;
  CLI::Option* bitrate_;
  CLI::Option* size_;
  CLI::Option* from_;
  CLI::Option* to_;
  CLI::Option* urgent_;
  CLI::Option* id_;
  CLI::Option* seed_;
  CLI::Option* count_;
  CLI::Option* time_;
  CLI::Option* quiet_;
  CLI::Option* timeout_;
  CLI::Option* verbose_;
};

}  // namespace roio::cli

#endif
