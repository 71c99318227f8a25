#include "bridged_bus.hpp"

#include <stdlib.h>

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
        port(bus, board, 0, {.link = device}) {}

  sim::Board board;
  sim::SerialPty port;
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
  network_.in_simulation(
      [this](sim::CanBus& bus) { bridges_.push_back(std::make_unique<Bridge>(bus, device_)); });
  return open(url(), options);
}

}  // namespace roio::test
