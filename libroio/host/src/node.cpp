#include <algorithm>
#include <roio/node.hpp>
#include <roio/parts/deadline.hpp>
#include <roio/text.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

namespace roio {
namespace {

// Looked through for a message after the deadline, before a call gives up on a bus that goes on.
constexpr int max_late_batches = 16;

}  // namespace

Node::Node(std::unique_ptr<Bus> bus, Address own, const NodeOptions& options)
    : Node(std::move(bus), interest_of(own), options) {}

Node::Node(std::unique_ptr<Bus> bus, const Interest& interest, const NodeOptions& options)
    : bus_(std::move(bus)), interest_(interest), batch_() {
  if (!bus_) {
    throw std::invalid_argument("Node: no bus given");
  }
  if (compile(interest_, program_) != Status::ok) {
    throw std::invalid_argument("Node: own address " + to_string(interest_.own) +
                                " is out of range; expected subnet 0..31 and node 0..254");
  }
  std::vector<SocketCanFilter> filters(program_.size());
  std::transform(program_.begin(), program_.end(), filters.begin(), to_socketcan);
  if (options.background) {
    bus_->begin_set_filters(filters);
  } else {
    bus_->set_filters(filters);
  }
}

Result Node::send(Address destination, std::span<const std::uint8_t> data, Priority priority,
                  Timeout timeout) {
  if (data.size() > max_data_length) {
    throw std::invalid_argument("Node::send: " + std::to_string(data.size()) +
                                " bytes; a message carries at most 8");
  }
  Message message{};
  message.header = Header{priority, MessageClass::message, destination, interest_.own};
  message.length = static_cast<std::uint8_t>(data.size());
  std::copy(data.begin(), data.end(), message.data);
  return send(message, timeout);
}

Result Node::send(const Message& message, Timeout timeout) {
  Message own = message;
  own.header.source = interest_.own;
  Frame frame{};
  if (to_frame(own, frame) != Status::ok) {
    throw std::invalid_argument(
        "Node::send: header out of range; expected destination subnet 0..31, class message, system "
        "or "
        "stream, at most 8 bytes");
  }
  return bus_->send(frame, timeout);
}

Result Node::receive(ReceivedMessage& message, Timeout timeout) {
  const Deadline deadline(timeout);
  int late_batches = 0;
  for (;;) {
    while (next_ < end_) {
      if (take(batch_[next_++], message)) {
        return Result::ok;
      }
    }
    // A bus gives what it has even when the time is up. Frames that are no message must not keep
    // the call for ever, however many come.
    if (deadline.passed() && late_batches++ == max_late_batches) {
      return Result::timeout;
    }
    const Transfer transfer = bus_->receive(batch_, deadline.remaining());
    if (transfer.result != Result::ok) {
      return transfer.result;
    }
    next_ = 0;
    end_ = transfer.count;
  }
}

bool Node::take(const Received& received, ReceivedMessage& message) {
  lost_before_ += received.lost_before;
  switch (to_message(received.frame, message.message)) {
    case Status::ok:
      break;
    case Status::not_roio:
      ++counters_.foreign;
      return false;
    case Status::unknown_class:
      ++counters_.unknown_class;
      return false;
    default:
      ++counters_.invalid_source;
      return false;
  }
  if (!program_.accepts(received.frame.id)) {
    ++counters_.not_wanted;
    return false;
  }
  message.time = received.time;
  message.lost_before = std::exchange(lost_before_, 0);
  return true;
}

}  // namespace roio
