/// Node: a Bus with an address of its own. Sends messages from that address and receives what its
/// interest wants; everything else is kept away by the filters, or counted.
///
///   roio::Node node(roio::open("can0"), roio::Address{0, 10});
///   node.send({0, 2}, std::array<std::uint8_t, 3>{90, 45, 0});
#ifndef ROIO_NODE_HPP
#define ROIO_NODE_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include <roio/bus.hpp>
#include <roio/export.hpp>
#include <roio/filter.hpp>
#include <roio/message.hpp>

namespace roio {

struct ReceivedMessage {
  Message message;
  Timestamp time;
  std::uint64_t lost_before;  ///< As in Received.

  [[nodiscard]] std::span<const std::uint8_t> data() const {
    return {message.data, message.length};
  }
  [[nodiscard]] Address source() const { return message.header.source; }
  [[nodiscard]] bool is_broadcast() const { return roio::is_broadcast(message.header.destination); }
};

/// Frames that reached the node and were no message for it, by reason.
struct NodeCounters {
  std::uint64_t foreign = 0;         ///< Standard, remote and error frames.
  std::uint64_t unknown_class = 0;   ///< The reserved class.
  std::uint64_t invalid_source = 0;  ///< A broadcast address as source.
  std::uint64_t not_wanted = 0;      ///< Let through by a filter that could not say it exactly.
};

struct NodeOptions {
  /// The constructor does not wait until the node's filters hold: the bus's Events::filters tells.
  /// What comes before that and is not for the node is counted, as ever.
  bool background = false;
};

class ROIO_EXPORT Node {
 public:
  /// A node that hears its own address and broadcasts to its subnet.
  /// @throws std::invalid_argument: own is not 0..31 . 0..254, or bus is null.
  Node(std::unique_ptr<Bus> bus, Address own, const NodeOptions& options = {});
  /// A node that hears what `interest` says.
  Node(std::unique_ptr<Bus> bus, const Interest& interest, const NodeOptions& options = {});

  /// Sends up to 8 bytes to an address or to broadcast_of(subnet).
  /// @throws std::invalid_argument: more than 8 bytes, or a subnet above 31.
  [[nodiscard]] Result send(Address destination, std::span<const std::uint8_t> data,
                            Priority priority = Priority::normal,
                            Timeout timeout = std::chrono::seconds(1));
  /// Sends a message as it is, but from this node's address.
  [[nodiscard]] Result send(const Message& message, Timeout timeout = std::chrono::seconds(1));

  /// The next message for this node.
  [[nodiscard]] Result receive(ReceivedMessage& message, Timeout timeout);

  [[nodiscard]] Address address() const noexcept { return interest_.own; }
  [[nodiscard]] const NodeCounters& counters() const noexcept { return counters_; }
  [[nodiscard]] Bus& bus() noexcept { return *bus_; }
  [[nodiscard]] const Bus& bus() const noexcept { return *bus_; }

 private:
  static constexpr std::size_t batch_size = 32;  // frames fetched in one call of the bus
  static constexpr std::uint8_t max_rules = 80;  // 33 destinations in up to 2 class rules each fit

  bool take(const Received& received, ReceivedMessage& message);

  std::unique_ptr<Bus> bus_;
  Interest interest_;
  FilterProgram<max_rules> program_;
  NodeCounters counters_;
  std::array<Received, batch_size> batch_;
  std::size_t next_ = 0;  // the first of batch_ not yet looked at
  std::size_t end_ = 0;   // one past the last of batch_
  std::uint64_t lost_before_ =
      0;  // reported with frames that were no message; owed to the next one
};

}  // namespace roio

#endif
