/// What roio-sim writes to standard output: what boards show, a line each, as text or as JSON.
#ifndef ROIO_SIM_TOOL_REPORT_HPP
#define ROIO_SIM_TOOL_REPORT_HPP

#include <cstdint>
#include <memory>
#include <optional>
#include <roio/sim/time.hpp>
#include <string>
#include <string_view>

#include "program/output.hpp"

namespace roio::sim_tool {

using cli::Buffer;

struct Summary {
  sim::SimTime time{0};
  double behind_s = 0;  ///< Real time that was missed.
  std::uint64_t frames = 0;
  std::uint64_t errors = 0;
  double load = 0;
  std::optional<std::string> bus;
  std::uint64_t from_bus = 0;
  std::uint64_t to_bus = 0;
  std::uint64_t lost = 0;
};

class Report {
 public:
  Report() = default;
  Report(const Report&) = delete;
  Report& operator=(const Report&) = delete;
  virtual ~Report() = default;

  virtual void servo(sim::SimTime time, const std::string& board, const std::string& pin,
                     int degrees) = 0;
  virtual void pin(sim::SimTime time, const std::string& board, const std::string& pin,
                   bool high) = 0;
  /// @param uart as Arduino counts them: 0 is Serial. @param text a line without its end, any
  /// bytes.
  virtual void serial(sim::SimTime time, const std::string& board, int uart,
                      std::string_view text) = 0;
  /// @param state a mode of the chip, error-passive or bus-off.
  virtual void can(sim::SimTime time, const std::string& board, const std::string& state,
                   std::uint32_t bitrate_bps) = 0;
  /// @param path empty: it has none any more.
  virtual void terminal(sim::SimTime time, const std::string& board, const std::string& path) = 0;
  virtual void summary(const Summary& summary) = 0;

  /// Lines that are not written yet.
  [[nodiscard]] Buffer& out() { return out_; }

 private:
  Buffer out_;
};

std::unique_ptr<Report> text_report();
std::unique_ptr<Report> json_report();

/// One line "roio-sim: TEXT" on standard error.
void note(std::string_view text) noexcept;

}  // namespace roio::sim_tool

#endif
