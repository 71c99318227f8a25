/// HostNode: an ideal CAN adapter on the simulated bus: its queues have no end, it hears every
/// frame, and it loses none.
#ifndef ROIO_SIM_HOST_NODE_HPP
#define ROIO_SIM_HOST_NODE_HPP

#include <cstdint>
#include <deque>
#include <functional>
#include <roio/sim/can_bus.hpp>

namespace roio::sim {

class HostNode : private ControllerClient {
 public:
  using Receiver = std::function<void(const Frame&)>;

  HostNode(CanBus& bus, std::uint32_t bitrate_bps,
           Controller::Mode mode = Controller::Mode::normal);
  ~HostNode() override;
  HostNode(const HostNode&) = delete;
  HostNode& operator=(const HostNode&) = delete;

  /// Queues a frame; extended ones with bit 28 clear go ahead of those that have it set, and within
  /// these two the order is kept. A length of 9..15 is sent as that DLC with 8 bytes.
  /// @throws std::invalid_argument for an error report, an identifier or a length out of range.
  void send(const Frame& frame);
  /// Called with every frame of others, once it is whole.
  void on_receive(Receiver receiver) { receiver_ = std::move(receiver); }
  /// Called with every frame of its own that was sent.
  void on_sent(Receiver receiver) { sent_ = std::move(receiver); }

  [[nodiscard]] std::size_t waiting() const { return urgent_.size() + normal_.size(); }
  [[nodiscard]] std::uint64_t receive_errors_seen() const { return receive_errors_seen_; }
  [[nodiscard]] Controller& controller() { return controller_; }

 private:
  std::optional<Submission> next_submission() override;
  void on_transmitted() override;
  void on_arbitration_lost() override {}
  void on_transmit_error(BusError /*error*/) override {}
  void on_received(const Frame& frame) override;
  void on_receive_error(BusError /*error*/) override { ++receive_errors_seen_; }
  void on_confinement_changed() override {}

  CanBus& bus_;
  Controller controller_;
  std::deque<Submission> urgent_;
  std::deque<Submission> normal_;
  std::deque<Submission>* sending_ = nullptr;
  Receiver receiver_;
  Receiver sent_;
  std::uint64_t receive_errors_seen_ = 0;
};

}  // namespace roio::sim

#endif
