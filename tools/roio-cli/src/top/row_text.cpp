#include "top/row_text.hpp"

#include <fmt/format.h>

#include <roio/message.hpp>
#include <roio/text.hpp>

namespace roio::cli {

std::string rate_text(double rate) {
  if (rate <= 0) {
    return "-";
  }
  return rate < 9.995   ? fmt::format("{:.2f}", rate)
         : rate < 99.95 ? fmt::format("{:.1f}", rate)
                        : fmt::format("{:.0f}", rate);
}

std::string age_text(Timeout age) {
  const double s = std::chrono::duration<double>(age).count();
  constexpr double minute = 60;
  constexpr double hour = 60 * minute;
  constexpr double day = 24 * hour;
  return s < 9.95           ? fmt::format("{:.1f} s", s)
         : s < 100          ? fmt::format("{:.0f} s", s)
         : s < 100 * minute ? fmt::format("{:.0f} min", s / minute)
         : s < 100 * hour   ? fmt::format("{:.0f} h", s / hour)
                            : fmt::format("{:.0f} d", s / day);
}

RowText row_text(const TrafficRow& row, const Labels& labels) {
  RowText text;
  text.rate = rate_text(row.rate);
  text.age = age_text(row.age);
  Message message{};
  text.is_message = to_message(row.last, message) == Status::ok;
  if (!text.is_message) {
    const bool extended = is_extended(row.last.kind);
    text.source = extended ? "29-bit" : "11-bit";
    text.destination =
        extended ? fmt::format("{:08X}", row.last.id) : fmt::format("{:03X}", row.last.id);
    text.message_class = "foreign";
    text.message = fmt::format("[{}]", row.last.length);
    return text;
  }
  text.source = labels.address(message.header.source);
  text.destination = labels.address(message.header.destination);
  text.priority = to_string(message.header.priority);
  text.message_class = to_string(message.header.message_class);
  MessageLabel label = labels.message(message);
  text.message = std::move(label.name);
  text.fields = std::move(label.fields);
  return text;
}

}  // namespace roio::cli
