#include "kind/latin1.hpp"

namespace roio::cli {

// UTF-8: a character up to 7Fh is one byte, up to FFh two, the first of them C2h or C3h; bytes from
// 80h to BFh go on with a character. (RFC 3629)
Latin1 to_latin1(std::string_view text) {
  Latin1 result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte < 0x80) {
      result.text += text[i];
    } else if ((byte == 0xC2 || byte == 0xC3) && i + 1 < text.size()) {
      const auto next = static_cast<unsigned char>(text[++i]);
      result.text += static_cast<char>(((byte & 0x03U) << 6U) | (next & 0x3FU));
    } else if (byte >= 0xC0) {
      result.text += '?';
      ++result.replaced;
    }
  }
  return result;
}

}  // namespace roio::cli
