#ifndef ROIO_TESTS_FUZZ_FRAMES_HPP
#define ROIO_TESTS_FUZZ_FRAMES_HPP

#include <algorithm>
#include <roio/frame.hpp>

namespace roio::fuzz {

inline bool same(const Frame& a, const Frame& b) {
  return tagged_id(a) == tagged_id(b) && a.length == b.length &&
         std::equal(a.data, a.data + max_data_length, b.data);
}

}  // namespace roio::fuzz

#endif
