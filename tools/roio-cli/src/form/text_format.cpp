#include <iterator>
#include <string_view>

#include "form/record_format.hpp"

namespace roio::cli {
namespace {

constexpr std::string_view bold_red = "\033[1;31m";
constexpr std::string_view plain = "\033[0m";

class TextFormat final : public RecordFormat {
 public:
  explicit TextFormat(const TextStyle& style) : style_(style), time_(style.time) {}

  void frame(Buffer& out, const Origin& from, const Received& received) override {
    time_.append(out, received.time);
    if (style_.bus_width > 0) {
      fmt::format_to(std::back_inserter(out), "{:<{}} ", from.log_name, style_.bus_width);
    }
    append_frame(out, received.frame, style_.colour, time_.gap(), style_.labels.get());
    out.push_back('\n');
  }

  bool news(Buffer& out, const Origin& from, const BusNews& news) override {
    const std::string where = style_.bus_width > 0 ? from.log_name + ": " : "";
    const bool in_colour = style_.colour != Colour::none;
    fmt::format_to(std::back_inserter(out), "{}! {}{}{}\n", in_colour ? bold_red : "", where,
                   to_text(news), in_colour ? plain : "");
    return true;
  }

 private:
  TextStyle style_;
  TimeColumn time_;
};

}  // namespace

std::unique_ptr<RecordFormat> text_format(const TextStyle& style) {
  return std::make_unique<TextFormat>(style);
}

}  // namespace roio::cli
