#include "target.hpp"

namespace {

std::string rebuilt(const roio::BusUrl& url) {
  using Kind = roio::BusUrl::Kind;
  const std::string kind = url.kind == Kind::socketcan ? "socketcan:"
                           : url.kind == Kind::local   ? "local:"
                                                       : "serial:";
  return kind + url.target + (url.bitrate ? "?bitrate=" + std::to_string(*url.bitrate) : "");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace roio;
  const std::string_view text = fuzz::as_text(data, size);
  const auto url = parse_bus_url(text);
  if (!url) {
    fuzz::require_good_error(url.error(), text);
    return 0;
  }
  fuzz::require(!url->target.empty(), "a bus has a name");
  fuzz::require(url->kind == BusUrl::Kind::serial || url->target.find('/') == std::string::npos,
                "a bus's name is no path");
  fuzz::require(!url->bitrate || (*url->bitrate >= 1000 && *url->bitrate <= 1000000),
                "a bit rate is within its range");
  const auto again = parse_bus_url(rebuilt(*url));
  fuzz::require(again && again->kind == url->kind && again->target == url->target &&
                    again->bitrate == url->bitrate,
                "a bus comes back");
  return 0;
}
