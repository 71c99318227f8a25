/// Traffic: the messages of a generator, one after the other, numbered. Pure, and the same for the
/// same seed.
#ifndef ROIO_CLI_TRAFFIC_HPP
#define ROIO_CLI_TRAFFIC_HPP

#include <cstdint>
#include <optional>
#include <random>
#include <roio/address.hpp>
#include <roio/frame.hpp>
#include <roio/header.hpp>

namespace roio::cli {

struct TrafficOptions {
  std::uint8_t id = 0;                 ///< Of the generator, 0..127.
  std::optional<Address> source;       ///< None: any.
  std::optional<Address> destination;  ///< None: any node.
  Priority priority = Priority::normal;
  std::uint8_t shortest = 8;  ///< Lengths, 4..8, each as often as another.
  std::uint8_t longest = 8;
  std::uint32_t seed = 0;

  /// Whether the seed matters.
  [[nodiscard]] bool is_random() const { return !source || !destination || shortest != longest; }
};

class Traffic {
 public:
  explicit Traffic(const TrafficOptions& options) : options_(options), random_(options.seed) {}

  Frame next();

 private:
  std::uint32_t below(std::uint32_t limit);
  Address any_node();

  TrafficOptions options_;
  std::mt19937 random_;
  std::uint32_t number_ = 0;
};

}  // namespace roio::cli

#endif
