#ifndef ROIO_TESTS_LOCAL_MEMORY_RIG_HPP
#define ROIO_TESTS_LOCAL_MEMORY_RIG_HPP

#include <sys/mman.h>

#include "local/log.hpp"
#include "local/readers.hpp"

namespace roio::test {

/// A bus's memory without a bus: what a hub would write there, and clients in its slots.
class MemoryRig {
 public:
  MemoryRig() { memory_.set_up(0); }

  [[nodiscard]] int fd() const { return fd_.get(); }
  local::Memory& operator*() { return *memory_; }
  local::Memory* operator->() { return &*memory_; }
  local::Readers& readers() { return readers_; }

  /// A client of number slot + 1 that begins here. @param filters none: it does not listen.
  local::Slot& add_client(std::size_t slot, std::span<const SocketCanFilter> filters) {
    local::Slot& its = memory_->slots.at(slot);
    its.client = slot + 1;
    its.position = local::pack({memory_->header.head + 1, 0});
    local::publish_filters(its, filters);
    readers_.add(slot);
    return its;
  }

  /// As a hub does it. The data is the frame's number.
  void carry(std::uint32_t tagged_id, std::uint64_t sender = 1000) {
    const std::uint64_t number = memory_->header.head + 1;
    if (number > local::log_size) {
      readers_.take_away(number - local::log_size);
    }
    local::WireFrame frame{tagged_id, 8, {}, {}};
    std::memcpy(frame.data.data(), &number, sizeof number);
    local::store(local::entry_of(*memory_, number), {sender, number, normal_lane, 0, frame});
    memory_->header.head = number;
  }
  void carry_many(std::uint64_t count, std::uint32_t tagged_id) {
    for (std::uint64_t i = 0; i < count; ++i) {
      carry(tagged_id);
    }
  }

 private:
  UniqueFd fd_{::memfd_create("test", MFD_CLOEXEC)};
  local::HubMemory memory_{fd_.get()};
  local::Readers readers_{*memory_};
};

}  // namespace roio::test

#endif
