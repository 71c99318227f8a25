#ifndef ROIO_SERIAL_PORT_OPENER_HPP
#define ROIO_SERIAL_PORT_OPENER_HPP

#include <chrono>
#include <optional>
#include <roio/parts/deadline.hpp>
#include <roio/parts/fd.hpp>
#include <string>
#include <system_error>
#include <vector>

#include "serial/port.hpp"

namespace roio::serial {

/// Opens the port of a bus, the first time and again after every end: the one that was named, or
/// for "auto" the one that has a bridge. For one thread at a time.
class PortOpener {
 public:
  /// @param name of the bus, for errors. @param target a path, or "auto".
  PortOpener(std::string name, std::string target);

  /// Empty: not known yet.
  [[nodiscard]] const std::string& path() const { return path_; }

  /// How long to wait before open(): nothing before the first.
  [[nodiscard]] std::chrono::milliseconds pause() const;

  /// @param deadline for finding a bridge the first time. @param stop ends that early.
  /// @throws std::system_error: see SerialPort and find_the_bridge().
  SerialPort open(const Deadline& deadline, const EventFlag& stop);

 private:
  void find(const Deadline& deadline, const EventFlag& stop);

  const std::string name_;
  std::string path_;
  bool has_tried_ = false;
  bool was_open_ = false;
  std::vector<std::string> searched_;
  std::optional<std::system_error> not_found_;  // in those
};

}  // namespace roio::serial

#endif
