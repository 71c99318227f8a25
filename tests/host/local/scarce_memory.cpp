#include "scarce_memory.hpp"

#include <cstdlib>
#include <new>

namespace roio::test {

std::atomic<bool> memory_is_scarce{false};
thread_local bool is_spared = false;

}  // namespace roio::test

void* operator new(std::size_t size) {
  const bool refused = roio::test::memory_is_scarce && !roio::test::is_spared;
  void* const memory = refused ? nullptr : std::malloc(size);
  if (memory == nullptr) {
    throw std::bad_alloc();
  }
  return memory;
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
