#ifndef ROIO_LOCAL_SENDERS_HPP
#define ROIO_LOCAL_SENDERS_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>

#include "local/protocol.hpp"

namespace roio::local {

/// What a client has had from each sender, so that it takes no frame twice.
class Senders {
 public:
  /// Whether a frame is new; from then on it is not, nor is any before it in that lane.
  bool is_new(std::uint64_t sender, std::size_t lane, std::uint64_t sequence);

 private:
  // Past this many, the one not heard for longest is forgotten: it matters only while a sender may
  // still offer frames again, which is for moments.
  static constexpr std::size_t max_senders = 4096;

  struct Entry {
    std::array<std::uint64_t, lane_count> last{};
    std::uint64_t heard = 0;
  };
  void forget_one();

  std::unordered_map<std::uint64_t, Entry> senders_;
  std::uint64_t heard_ = 0;
};

}  // namespace roio::local

#endif
