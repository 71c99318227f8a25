/// How JSON and CSV call the kinds of frames.
#ifndef ROIO_CLI_KIND_NAME_HPP
#define ROIO_CLI_KIND_NAME_HPP

#include <roio/frame.hpp>

namespace roio::cli {

constexpr const char* kind_name(FrameKind kind) noexcept {
  switch (kind) {
    case FrameKind::standard:
      return "standard";
    case FrameKind::standard_remote:
      return "standard-remote";
    case FrameKind::extended:
      return "extended";
    case FrameKind::extended_remote:
      return "extended-remote";
    case FrameKind::error:
      break;
  }
  return "error";
}

}  // namespace roio::cli

#endif
