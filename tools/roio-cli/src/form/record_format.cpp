#include "form/record_format.hpp"

namespace roio::cli {

std::string to_text(const BusNews& news) {
  switch (news.kind) {
    case BusNews::Kind::lost:
      return count_of(news.count, "frame") + " lost";
    case BusNews::Kind::not_shown:
      return fd_frames_not_shown(news.count);
    case BusNews::Kind::state:
      break;
  }
  return std::string("bus is ") + to_string(news.state);
}

std::string count_of(std::uint64_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

std::string fd_frames_not_shown(std::uint64_t count) {
  return count_of(count, "CAN FD frame") + " not shown";
}

}  // namespace roio::cli
