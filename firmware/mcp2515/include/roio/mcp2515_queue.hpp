/// The driver's two queues. Fixed size, no heap; a size of 0 costs nothing and is always full.
#ifndef ROIO_MCP2515_QUEUE_HPP
#define ROIO_MCP2515_QUEUE_HPP

#include <stdint.h>

namespace roio {
namespace mcp2515 {

/// First in, first out.
template <typename Entry, uint8_t Capacity>
class Ring {
 public:
  constexpr Ring() : entries_(), first_(0), size_(0) {}

  bool empty() const { return size_ == 0; }
  bool full() const { return size_ == Capacity; }
  uint8_t size() const { return size_; }
  Entry& front() { return entries_[first_]; }
  Entry& operator[](uint8_t index) { return entries_[slot(index)]; }
  /// The place behind the last entry; commit() makes it one. Not when full.
  Entry& next() { return entries_[slot(size_)]; }
  void commit() { ++size_; }
  void pop() {
    first_ = slot(1);
    --size_;
  }

 private:
  static_assert(Capacity <= 127, "indices of a ring fit in 8 bits");

  uint8_t slot(uint8_t index) const {
    const uint8_t slot = static_cast<uint8_t>(first_ + index);
    return slot < Capacity ? slot : static_cast<uint8_t>(slot - Capacity);
  }

  Entry entries_[Capacity];
  uint8_t first_;
  uint8_t size_;
};

template <typename Entry>
class Ring<Entry, 0> {
 public:
  bool empty() const { return true; }
  bool full() const { return true; }
  uint8_t size() const { return 0; }
  // Never called: there is no entry. They have to compile all the same.
  Entry& front() { __builtin_unreachable(); }
  Entry& operator[](uint8_t) { return front(); }
  Entry& next() { return front(); }
  void commit() {}
  void pop() {}
};

}  // namespace mcp2515
}  // namespace roio

#endif
