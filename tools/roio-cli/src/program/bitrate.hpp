/// The bit rate of a bus, from whoever knows it: the user, the bus's name, the bridge, the kernel.
#ifndef ROIO_CLI_BITRATE_HPP
#define ROIO_CLI_BITRATE_HPP

#include <cstdint>
#include <optional>
#include <roio/bus.hpp>
#include <string>

namespace roio::cli {

inline constexpr std::uint32_t slowest_bitrate_bps = 1000;
inline constexpr std::uint32_t fastest_bitrate_bps = 1'000'000;

class BitrateSource {
 public:
  /// @param bus must outlive this. @param url it was opened by. @param told by the user.
  BitrateSource(Bus& bus, const std::string& url, std::optional<std::uint32_t> told);

  /// As it is now; none: nobody knows. Does not wait. The kernel is asked when the bus's state has
  /// changed since.
  [[nodiscard]] std::optional<std::uint32_t> bps();

 private:
  void ask_kernel();

  Bus& bus_;
  std::optional<std::uint32_t> known_;
  std::string interface_;  // empty: it is no CAN interface
  std::optional<BusState> asked_in_;
  std::optional<std::uint32_t> told_by_kernel_;
};

}  // namespace roio::cli

#endif
