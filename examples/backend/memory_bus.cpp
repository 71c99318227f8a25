#include "memory_bus.hpp"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <optional>
#include <roio/error.hpp>
#include <roio/parts.hpp>
#include <system_error>
#include <utility>
#include <vector>

namespace {

// As much may wait for a program that does not read; what comes then is dropped, and counted.
constexpr std::size_t receive_capacity = 16384;
constexpr std::size_t max_filters = 512;  // as the contract says

class MemoryBus;

}  // namespace

/// Who takes part, and the lock over all of them: frames are on the wire one after the other, so
/// that everybody sees them in one order.
struct MemoryWire {
  std::string name;
  std::mutex mutex;
  std::vector<MemoryBus*> participants;
};

namespace {

class MemoryBus final : public roio::Bus {
 public:
  MemoryBus(std::shared_ptr<MemoryWire> wire, const roio::OpenOptions& options)
      : wire_(std::move(wire)) {
    if (!options.send_only) {
      filters_.push_back({0, 0});  // everything
    }
    const std::lock_guard lock(wire_->mutex);
    wire_->participants.push_back(this);
  }
  MemoryBus(const MemoryBus&) = delete;
  MemoryBus& operator=(const MemoryBus&) = delete;
  ~MemoryBus() override { close(); }

  using Bus::receive;
  using Bus::send;

  roio::Transfer send(std::span<const roio::Frame> frames, roio::Timeout timeout) override {
    roio::check_sendable(frames);
    return roio::send_queued(
        waits_, events_, frames, timeout,
        [this](std::span<const roio::Frame> rest) { return deliver(rest); },
        [this](bool gives_up) {
          const std::lock_guard lock(wire_->mutex);
          ++(gives_up ? statistics_.send_timeouts : statistics_.send_waits);
        });
  }

  roio::Transfer receive(std::span<roio::Received> frames, roio::Timeout timeout) override {
    return roio::receive_queued(waits_, queue_.readable(), frames, timeout,
                                [this](std::span<roio::Received> room) { return take(room); });
  }

  void set_filters(std::span<const roio::SocketCanFilter> filters) override {
    if (filters.size() > max_filters) {
      throw std::system_error(roio::Errc::too_many_filters, name());
    }
    const std::lock_guard lock(wire_->mutex);
    filters_.assign(filters.begin(), filters.end());
  }
  void begin_set_filters(std::span<const roio::SocketCanFilter> filters) override {
    set_filters(filters);
    events_.tell(&roio::Events::filters);
  }

  int fd() const noexcept override { return queue_.readable().fd(); }
  int event_fd() const noexcept override { return events_.fd(); }
  roio::Events take_events() override { return events_.take(); }
  roio::BusState state() const override {
    return waits_.is_closed() ? roio::BusState::absent : roio::BusState::active;
  }
  roio::Statistics statistics() const override {
    const std::lock_guard lock(wire_->mutex);
    roio::Statistics statistics = statistics_;
    queue_.add_to(statistics);
    return statistics;
  }
  void cancel() noexcept override { waits_.cancel(); }
  void resume() noexcept override { waits_.resume(); }
  void close() noexcept override {
    const std::lock_guard lock(wire_->mutex);
    if (!waits_.is_closed()) {
      waits_.close();
      std::erase(wire_->participants, this);
      events_.tell(&roio::Events::closed);
    }
  }
  void begin_close() noexcept override { close(); }
  const std::string& name() const noexcept override { return wire_->name; }

 private:
  /// Gives the frames to all others. Nothing waits here: who has no room is told what it missed.
  std::optional<std::size_t> deliver(std::span<const roio::Frame> frames) {
    const std::lock_guard lock(wire_->mutex);
    if (waits_.is_closed()) {
      return std::nullopt;
    }
    for (const roio::Frame& frame : frames) {
      const roio::Timestamp now = std::chrono::system_clock::now();
      for (MemoryBus* const other : wire_->participants) {
        if (other != this && other->wants(frame)) {
          other->queue_.put(frame, now);
          other->look_for_events();
        }
      }
    }
    statistics_.sent += frames.size();
    return frames.size();
  }

  std::optional<std::size_t> take(std::span<roio::Received> room) {
    const std::lock_guard lock(wire_->mutex);
    return waits_.is_closed() ? std::nullopt : std::optional(queue_.take(room));
  }

  void look_for_events() {
    roio::Statistics statistics;
    queue_.add_to(statistics);
    events_.look(roio::BusState::active, statistics.dropped);
  }

  bool wants(const roio::Frame& frame) const {
    const std::uint32_t tagged = roio::tagged_id(frame);
    return std::ranges::any_of(
        filters_, [tagged](const auto& filter) { return roio::accepts(filter, tagged); });
  }

  const std::shared_ptr<MemoryWire> wire_;
  roio::Waits waits_;
  roio::BusEvents events_;  // never of room: all that is offered goes at once

  // Under the wire's lock.
  std::vector<roio::SocketCanFilter> filters_;
  roio::ReceiveQueue queue_{receive_capacity};
  roio::Statistics statistics_;
};

}  // namespace

std::shared_ptr<MemoryWire> make_memory_wire(std::string name) {
  auto wire = std::make_shared<MemoryWire>();
  wire->name = std::move(name);
  return wire;
}

std::unique_ptr<roio::Bus> open_memory_bus(std::shared_ptr<MemoryWire> wire,
                                           const roio::OpenOptions& options) {
  return std::make_unique<MemoryBus>(std::move(wire), options);
}
