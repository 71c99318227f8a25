/// PtyTerminal: a pseudo terminal, from the side of the device that it stands for. It is raw, and
/// stays so when programs come and go; its end is a hang-up for those that have it open.
#ifndef ROIO_SIM_PTY_TERMINAL_HPP
#define ROIO_SIM_PTY_TERMINAL_HPP

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace roio::sim {

class PtyTerminal {
 public:
  /// @throws std::system_error: no terminal to be had.
  PtyTerminal();

  /// What programs open, such as /dev/pts/3.
  [[nodiscard]] const std::string& path() const { return path_; }
  /// The line rate that a program has set; none: it has set none.
  [[nodiscard]] std::optional<double> bitrate_bps() const;
  /// Never waits. @return how many bytes a program had written: the first of `room` are set.
  std::size_t read(std::span<std::uint8_t> room);
  /// Never waits. @return how many there was room for.
  std::size_t write(std::span<const std::uint8_t> bytes);

 private:
  class Descriptor {
   public:
    Descriptor(int fd, const char* what);
    ~Descriptor();
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    [[nodiscard]] int get() const { return fd_; }

   private:
    int fd_;
  };

  Descriptor master_;
  std::string path_;
  Descriptor slave_;  // kept open, so that the terminal keeps its settings
};

}  // namespace roio::sim

#endif
