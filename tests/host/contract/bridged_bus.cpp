#include "bridged_bus.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <roio/sim/board.hpp>
#include <roio/sim/serial_pty.hpp>
#include <stdexcept>

namespace roio::test {
namespace {

std::string make_folder() {
  std::string name = std::filesystem::temp_directory_path() / "roio-bridges-XXXXXX";
  if (::mkdtemp(name.data()) == nullptr) {
    throw std::runtime_error("mkdtemp " + name);
  }
  return name;
}

}  // namespace

struct BridgedBus::Bridge {
  Bridge(sim::CanBus& bus, const std::string& device)
      : board(bus, sim::BoardKind::uno, ROIO_IMAGES_DIR "/uno/bridge_usb.elf"),
        port(bus, board, 0, {.link = device}),
        terminal(std::filesystem::read_symlink(device)) {}

  /// Whoever has it open holds a lock.
  [[nodiscard]] bool is_free() const {
    const int fd = ::open(terminal.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    const bool is_free = fd >= 0 && ::flock(fd, LOCK_EX | LOCK_NB) == 0;
    ::close(fd);
    return is_free;
  }
  /// The device is this board's from now on.
  void take_device(const std::string& device) {
    port.unplug();
    port.plug();
    terminal = std::filesystem::read_symlink(device);
  }

  sim::Board board;
  sim::SerialPty port;
  std::filesystem::path terminal;
};

BridgedBus::BridgedBus()
    : folder_(make_folder()),
      device_(folder_ + "/bridge"),
      network_(sim::NetworkOptions{.bitrate_bps = 500'000, .witness = true}) {}

BridgedBus::~BridgedBus() {
  network_.in_simulation([this](sim::CanBus&) { bridges_.clear(); });
  std::filesystem::remove_all(folder_);
}

std::unique_ptr<Bus> BridgedBus::join(const OpenOptions& options) {
  // Each board costs time, so one that has been left is taken again.
  network_.in_simulation([this](sim::CanBus& bus) {
    const auto free = std::find_if(bridges_.begin(), bridges_.end(),
                                   [](const auto& bridge) { return bridge->is_free(); });
    if (free != bridges_.end()) {
      (*free)->take_device(device_);
    } else {
      bridges_.push_back(std::make_unique<Bridge>(bus, device_));
    }
  });
  return open(url(), options);
}

}  // namespace roio::test
