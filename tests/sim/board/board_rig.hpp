/// A board that runs one of the programs in firmware/, and what it sends on its first UART.
#ifndef ROIO_TESTS_BOARDS_BOARD_RIG_HPP
#define ROIO_TESTS_BOARDS_BOARD_RIG_HPP

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <roio/sim/board.hpp>
#include <roio/sim/can_bus.hpp>
#include <string>
#include <vector>

namespace roio::test {

using namespace std::chrono_literals;
using Bytes = std::vector<std::uint8_t>;

inline std::filesystem::path firmware(const std::string& program, const char* mcu) {
  return std::filesystem::path(ROIO_FIRMWARE_DIR) / (program + "." + mcu + ".elf");
}

constexpr sim::SimTime cpu_cycles(std::int64_t count) {
  return sim::cycles(count, 16'000'000);
}

struct BoardRig {
  BoardRig(sim::CanBus& bus, sim::BoardKind kind, const std::string& program,
           const sim::BoardOptions& options = {})
      : uart(kind == sim::BoardKind::leonardo ? 1 : 0),
        board(bus, kind, firmware(program, sim::mcu_of(kind)), options) {
    board.on_serial(uart, [this, &bus](std::uint8_t byte) {
      sent.push_back(byte);
      sent_at.push_back(bus.now());
    });
  }
  void write(const Bytes& bytes) { board.serial_write(uart, bytes); }
  /// What was sent as numbers of 16 bits, the first byte the higher.
  [[nodiscard]] std::vector<int> words() const {
    std::vector<int> result;
    for (std::size_t i = 0; i + 1 < sent.size(); i += 2) {
      result.push_back(sent[i] << 8 | sent[i + 1]);
    }
    return result;
  }

  int uart;
  sim::Board board;
  Bytes sent;
  std::vector<sim::SimTime> sent_at;
};

class EachBoard : public testing::TestWithParam<sim::BoardKind> {
 protected:
  sim::CanBus bus_;
};

inline const auto all_boards =
    testing::Values(sim::BoardKind::uno, sim::BoardKind::leonardo, sim::BoardKind::mega);
inline std::string board_name(const testing::TestParamInfo<sim::BoardKind>& kind) {
  return sim::to_string(kind.param);
}

}  // namespace roio::test

#endif
