#ifndef ROIO_TESTS_LOCAL_SCARCE_MEMORY_HPP
#define ROIO_TESTS_LOCAL_SCARCE_MEMORY_HPP

#include <atomic>

namespace roio::test {

/// While it is true, operator new of the whole program throws std::bad_alloc,
extern std::atomic<bool> memory_is_scarce;
/// but not in threads that are spared.
extern thread_local bool is_spared;

}  // namespace roio::test

#endif
