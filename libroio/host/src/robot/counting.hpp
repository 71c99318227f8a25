#ifndef ROIO_ROBOT_COUNTING_HPP
#define ROIO_ROBOT_COUNTING_HPP

#include <cstddef>
#include <iterator>

namespace roio::robot_file {

/// Goes over a text, and counts the bytes that were taken from it, whoever has copied the iterator.
/// For one that goes over it once.
class CountingIterator {
 public:
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;
  using iterator_category = std::input_iterator_tag;

  CountingIterator(const char* at, std::size_t& taken) : at_(at), taken_(&taken) {}

  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    ++at_;
    ++*taken_;
    return *this;
  }
  CountingIterator operator++(int) {
    const CountingIterator before = *this;
    ++*this;
    return before;
  }
  friend bool operator==(const CountingIterator& a, const CountingIterator& b) {
    return a.at_ == b.at_;
  }

 private:
  const char* at_;
  std::size_t* taken_;
};

}  // namespace roio::robot_file

#endif
