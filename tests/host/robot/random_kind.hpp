#ifndef ROIO_TESTS_ROBOT_RANDOM_KIND_HPP
#define ROIO_TESTS_ROBOT_RANDOM_KIND_HPP

#include <algorithm>
#include <random>
#include <string>

#include "seed.hpp"

namespace roio::test {

/// Writes messages of random fields, as a person could.
class RandomKind {
 public:
  explicit RandomKind(std::mt19937& random) : random_(random) {}

  /// A kind "k" that hears one message, "m", of 8 bytes at most.
  std::string text() {
    bits_left_ = 64;
    std::string tag;
    if (chance(2)) {
      tag = "\"tag\": " + std::to_string(up_to(random_, 255)) + ", ";
      bits_left_ -= 8;
    }
    std::string fields;
    for (unsigned i = 0; i < 12 && bits_left_ > 0; ++i) {
      const std::string field = random_field(i);
      fields += (fields.empty() || field.empty() ? "" : ",\n") + field;
      if (field.empty() || ended_) {
        break;
      }
    }
    ended_ = false;
    return R"({"roio": 1, "kind": "k", "hears": {"m": {)" + tag + "\"fields\": [" + fields + "]}}}";
  }

 private:
  bool chance(std::uint32_t of) { return up_to(random_, of - 1) == 0; }

  /// Empty: no room for it.
  std::string random_field(unsigned index) {
    static constexpr const char* types[] = {"u8",  "u16", "u24",  "u32",  "i8",   "i16",
                                            "i24", "i32", "bits", "bits", "enum", "bytes"};
    static constexpr unsigned widths[] = {8, 16, 24, 32, 8, 16, 24, 32, 0, 0, 0, 0};
    const std::uint32_t which = up_to(random_, 11);
    const std::string type = types[which];
    unsigned width = widths[which] != 0 ? widths[which] : 1 + up_to(random_, 7);
    if (!take(type == "bytes" ? 8 : width)) {
      return "";
    }
    std::string out = "{\"name\": \"f" + std::to_string(index) + "\", \"type\": \"" + type + '"';
    if (type == "bits" || type == "enum") {
      out += ", \"width\": " + std::to_string(width);
    }
    if (type == "enum") {
      out += ", \"values\": " + random_values(width);
    } else if (type == "bytes") {
      ended_ = true;
    } else {
      out += random_scale();
    }
    return out + '}';
  }

  /// Whether a field of this width fits, by the rule of the document.
  bool take(unsigned width) {
    const unsigned in_byte = bits_left_ % 8;
    const unsigned left = width > in_byte ? bits_left_ - in_byte : bits_left_;
    if (width > left) {
      return false;
    }
    bits_left_ = left - width;
    return true;
  }

  std::string random_values(unsigned width) {
    const std::uint32_t count = 1 + up_to(random_, std::min(5U, (1U << width) - 1U));
    std::string out = "{";
    for (std::uint32_t i = 0; i < count; ++i) {
      out += (i == 0 ? "\"v" : ", \"v") + std::to_string(i) + "\": " + std::to_string(i);
    }
    return out + '}';
  }

  std::string random_scale() {
    const std::string numerator = std::to_string(1 + up_to(random_, chance(2) ? 9 : 999999));
    const std::string denominator = std::to_string(1 + up_to(random_, chance(2) ? 9 : 999999));
    switch (up_to(random_, 3)) {
      case 0:
        return ", \"scale\": \"" + numerator + '/' + denominator + '"';
      case 1:
        return ", \"scale\": " + numerator;
      case 2:
        return R"(, "scale": "1/10")";
      default:
        return "";
    }
  }

  std::mt19937& random_;
  unsigned bits_left_ = 0;
  bool ended_ = false;
};

}  // namespace roio::test

#endif
