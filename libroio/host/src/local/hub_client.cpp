#include "local/hub_client.hpp"

namespace roio::local {
namespace {

constexpr std::chrono::seconds greeting_time{5};

}  // namespace

bool HubClient::greeting_overdue(TimePoint now) const {
  return !greeted() && now - since_ > greeting_time;
}

bool HubClient::welcome(std::shared_ptr<Station> station, std::size_t slot,
                        const Welcome& welcome) {
  Buffer bytes;
  append_record(bytes, welcome);
  // The socket is fresh, so there is room.
  if (!send_with_fd(stream_.fd(), bytes, wake_.fd())) {
    return false;
  }
  station_ = std::move(station);
  slot_ = slot;
  return true;
}

void HubClient::refuse(const Refused& refused) {
  append_record(stream_.out(), refused);
  static_cast<void>(stream_.flush());
}

}  // namespace roio::local
