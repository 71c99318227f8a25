/// Whether the interrupt line works, as far as is known. Nothing is kept where there is none.
#ifndef ROIO_MCP2515_LINE_HPP
#define ROIO_MCP2515_LINE_HPP

namespace roio {
namespace mcp2515 {

template <bool IsThere>
class Line {
 public:
  constexpr Line() : is_on_(false) {}
  bool is_on() const { return is_on_; }
  void set_on(bool is_on) { is_on_ = is_on; }

 private:
  bool is_on_;
};

template <>
class Line<false> {
 public:
  static bool is_on() { return false; }
  static void set_on(bool) {}
};

}  // namespace mcp2515
}  // namespace roio

#endif
