#include "target.hpp"

namespace roio::fuzz {
namespace {

std::string rebuilt(const BusUrl& url) {
  using Kind = BusUrl::Kind;
  const std::string kind = url.kind == Kind::socketcan ? "socketcan:"
                           : url.kind == Kind::local   ? "local:"
                                                       : "serial:";
  return kind + url.target + (url.bitrate ? "?bitrate=" + std::to_string(*url.bitrate) : "");
}

}  // namespace

void check(std::string_view text) {
  const auto url = parse_bus_url(text);
  if (!url) {
    require_good_error(url.error(), text);
    return;
  }
  require(!url->target.empty(), "a bus has a name");
  require(url->kind == BusUrl::Kind::serial || url->target.find('/') == std::string::npos,
          "a bus's name is no path");
  require(!url->bitrate || (*url->bitrate >= 1000 && *url->bitrate <= 1000000),
          "a bit rate is within its range");
  const auto again = parse_bus_url(rebuilt(*url));
  require(again && again->kind == url->kind && again->target == url->target &&
              again->bitrate == url->bitrate,
          "a bus comes back");
}

}  // namespace roio::fuzz
