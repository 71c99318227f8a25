#ifndef ROIO_SERIAL_FILTERS_HPP
#define ROIO_SERIAL_FILTERS_HPP

#include <cstddef>
#include <roio/filter_socketcan.hpp>
#include <roio/frame.hpp>
#include <span>
#include <vector>

#include "serial/payloads.hpp"

namespace roio::serial {

/// What a program wants to receive: the bridge sorts out what it can, the rest is sorted out here.
class Filters {
 public:
  static constexpr std::size_t max_count = 512;  // as many as SocketCAN takes

  explicit Filters(bool everything) {
    if (everything) {
      filters_ = {{0, 0}};
    }
  }
  /// @param filters max_count at most.
  void set(std::span<const SocketCanFilter> filters) {
    filters_.assign(filters.begin(), filters.end());
  }

  /// As the bridge can have them: exactly, or everything when it cannot.
  [[nodiscard]] std::vector<Rule> rules() const;
  [[nodiscard]] bool pass(const Frame& frame) const;

 private:
  std::vector<SocketCanFilter> filters_;
};

}  // namespace roio::serial

#endif
