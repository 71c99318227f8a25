#include <array>
#include <roio/candump_log.hpp>

#include "form/record_format.hpp"

namespace roio::cli {
namespace {

class LogFormat final : public RecordFormat {
 public:
  void frame(Buffer& out, const Origin& from, const Received& received) override {
    std::array<char, max_log_line> line;
    const std::size_t length = format_log_line(line, received.time, from.log_name, received.frame);
    out.append(line.data(), line.data() + length);
  }
};

}  // namespace

std::unique_ptr<RecordFormat> log_format() {
  return std::make_unique<LogFormat>();
}

}  // namespace roio::cli
