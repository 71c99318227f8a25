/// Bridge: a node on the simulated bus that carries frames between it and a bus of this computer.
/// What comes from there arbitrates with the boards; what they send goes there. Frames that came
/// from there do not go back.
///
/// Flow: it takes only as many frames from the other bus as its node will send in a moment, so that
/// the rest waits where its senders are held up by it; and when the other bus takes no more,
/// is_blocked() asks for simulated time to wait. Nothing is dropped here.
#ifndef ROIO_SIM_TOOL_BRIDGE_HPP
#define ROIO_SIM_TOOL_BRIDGE_HPP

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <roio/bus.hpp>
#include <roio/sim/host_node.hpp>
#include <vector>

namespace roio::sim_tool {

class Bridge {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param outside null: none; the node still acknowledges what boards send.
  Bridge(sim::CanBus& bus, std::uint32_t bitrate_bps, std::unique_ptr<Bus> outside);
  Bridge(const Bridge&) = delete;
  Bridge& operator=(const Bridge&) = delete;
  ~Bridge() = default;

  /// From the other bus; never waits.
  void take();
  /// To the other bus, what it takes; never waits.
  /// @param now of Clock, not before that of the call before.
  /// @throws cli::Failure: it has taken nothing of what waits for it for longer than 5 s.
  void give(Clock::time_point now);

  /// The node is off: nothing passes, and nobody acknowledges what a board sends that is alone.
  void set_alone(bool alone);

  /// So much waits for the other bus that no more should come.
  [[nodiscard]] bool is_blocked() const;
  /// To be polled for input; -1: nothing could be taken now, or there is no other bus.
  [[nodiscard]] int fd() const;

  [[nodiscard]] const Bus* outside() const { return outside_.get(); }
  [[nodiscard]] std::uint64_t taken() const { return taken_; }
  [[nodiscard]] std::uint64_t given() const { return given_; }
  /// Frames for the boards that the other bus had no more room for, and frames that are still here.
  [[nodiscard]] std::uint64_t lost() const;

 private:
  [[nodiscard]] std::size_t room() const;

  sim::HostNode node_;
  std::unique_ptr<Bus> outside_;
  std::vector<Received> batch_;
  std::vector<Frame> waiting_;              // for the other bus
  std::optional<Clock::time_point> tried_;  // last
  Clock::duration stuck_{0};                // since the other bus last took something
  std::uint64_t taken_ = 0;
  std::uint64_t given_ = 0;
};

}  // namespace roio::sim_tool

#endif
