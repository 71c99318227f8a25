// What libFuzzer calls, for every target.
#include <cstddef>
#include <cstdint>

#include "target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  roio::fuzz::check({reinterpret_cast<const char*>(data), size});
  return 0;
}
