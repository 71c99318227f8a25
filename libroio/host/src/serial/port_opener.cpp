#include "serial/port_opener.hpp"

#include <roio/error.hpp>
#include <roio/serial_protocol.hpp>
#include <utility>

#include "serial/finder.hpp"
#include "serial/ports.hpp"

namespace roio::serial {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds retry{100};
// Until it has been open, looking who else has it costs a look at every process.
constexpr milliseconds at_first{1000};
constexpr Timeout later_search = std::chrono::seconds(3);  // an Uno's boot loader takes 2 s of it

}  // namespace

PortOpener::PortOpener(std::string name, std::string target)
    : name_(std::move(name)), path_(target == "auto" ? std::string() : std::move(target)) {}

milliseconds PortOpener::pause() const {
  if (!has_tried_) {
    return milliseconds(0);
  }
  return was_open_ ? retry : at_first;
}

SerialPort PortOpener::open(const Deadline& deadline, const EventFlag& stop) {
  has_tried_ = true;
  if (path_.empty()) {
    find(deadline, stop);
  }
  // Opening it would reset the board under whoever has it.
  if (!was_open_ && is_open_anywhere(path_)) {
    throw std::system_error(Errc::port_in_use, name_);
  }
  SerialPort port(path_, name_, base_rate_bps);
  was_open_ = true;
  return port;
}

// Looking for bridges resets boards, so it is done again only when there are other ports.
void PortOpener::find(const Deadline& deadline, const EventFlag& stop) {
  std::vector<std::string> ports = likely_ports();
  if (not_found_ && ports == searched_) {
    throw std::system_error(*not_found_);
  }
  searched_ = std::move(ports);
  try {
    path_ = find_the_bridge(name_, not_found_ ? later_search : deadline.remaining(), stop);
  } catch (const std::system_error& error) {
    not_found_ = error;
    throw;
  }
}

}  // namespace roio::serial
