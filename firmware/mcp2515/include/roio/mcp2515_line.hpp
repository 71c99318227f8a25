/// Whether the interrupt line works, as far as is known. Nothing is kept where there is none.
#ifndef ROIO_MCP2515_LINE_HPP
#define ROIO_MCP2515_LINE_HPP

namespace roio {
namespace mcp2515 {

/// @tparam IsDoubted whether it may turn out not to work.
template <bool IsThere, bool IsDoubted>
class Line {
 public:
  constexpr Line() : is_on_(false) {}
  bool is_on() const { return is_on_; }
  void set_on(bool is_on) { is_on_ = is_on; }

 private:
  bool is_on_;
};

template <bool IsDoubted>
class Line<false, IsDoubted> {
 public:
  static bool is_on() { return false; }
  static void set_on(bool) {}
};

template <>
class Line<true, false> {
 public:
  static bool is_on() { return true; }
  static void set_on(bool) {}
};

}  // namespace mcp2515
}  // namespace roio

#endif
