#include <roio/header.hpp>
#include <roio/sim/host_node.hpp>
#include <stdexcept>

namespace roio::sim {

HostNode::HostNode(CanBus& bus, std::uint32_t bitrate_bps, Controller::Mode mode)
    : bus_(bus), controller_(*this) {
  bus_.join(controller_, timing_of(bitrate_bps));
  controller_.set_mode(mode);
}

HostNode::~HostNode() {
  bus_.leave(controller_);
}

void HostNode::send(const Frame& frame) {
  constexpr std::uint8_t largest_dlc = 15;
  if (frame.kind == FrameKind::error || frame.id > max_id(frame.kind) ||
      frame.length > largest_dlc) {
    throw std::invalid_argument("no frame that a bus can carry");
  }
  const bool urgent = is_extended(frame.kind) && unpack_id(frame.id).priority == Priority::urgent;
  (urgent ? urgent_ : normal_).push_back({frame, bus_.now()});
  controller_.request();
}

std::optional<Submission> HostNode::next_submission() {
  sending_ = !urgent_.empty() ? &urgent_ : &normal_;
  return sending_->empty() ? std::nullopt : std::optional(sending_->front());
}

void HostNode::on_transmitted() {
  const Frame frame = sending_->front().frame;
  sending_->pop_front();
  if (sent_) {
    sent_(frame);
  }
}

void HostNode::on_received(const Frame& frame) {
  if (receiver_) {
    receiver_(frame);
  }
}

}  // namespace roio::sim
