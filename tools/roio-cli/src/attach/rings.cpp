#include "attach/rings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>

namespace roio::cli {
namespace {

constexpr std::string_view prefix = "roio-attach:";
constexpr std::size_t digits = 16;

std::optional<std::uint64_t> parse_number(std::string_view text) {
  std::uint64_t value = 0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value, 16);
  return error == std::errc() && end == last ? std::optional(value) : std::nullopt;
}

}  // namespace

bool closes_ring(std::span<const Joint> others, const Joint& joint) {
  std::set<std::uint64_t> reached{joint.first};
  for (std::size_t before = 0; before != reached.size();) {
    before = reached.size();
    for (const Joint& other : others) {
      if (reached.count(other.first) + reached.count(other.second) == 1) {
        reached.insert({other.first, other.second});
      }
    }
  }
  return reached.contains(joint.second);
}

// FNV-1a. Source: www.isthe.com/chongo/tech/comp/fnv.
std::uint64_t number_of(std::string_view full_name) {
  std::uint64_t hash = 0xCBF29CE484222325U;
  for (const char byte : full_name) {
    hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001B3U;
  }
  return hash;
}

std::string name_of(const Joint& joint) {
  const auto [low, high] = std::minmax(joint.first, joint.second);
  return fmt::format("{}{:016x}-{:016x}", prefix, low, high);
}

std::optional<Joint> parse_joint(std::string_view name) {
  if (!name.starts_with(prefix) || name.size() != prefix.size() + 2 * digits + 1 ||
      name[prefix.size() + digits] != '-') {
    return std::nullopt;
  }
  name.remove_prefix(prefix.size());
  const auto first = parse_number(name.substr(0, digits));
  const auto second = parse_number(name.substr(digits + 1));
  return first && second ? std::optional(Joint{*first, *second}) : std::nullopt;
}

std::vector<Joint> joints_in(std::string_view unix_sockets) {
  std::vector<Joint> joints;
  while (!unix_sockets.empty()) {
    const std::string_view line = unix_sockets.substr(0, unix_sockets.find('\n'));
    unix_sockets.remove_prefix(std::min(line.size() + 1, unix_sockets.size()));
    // An abstract socket's name begins with '@' there.
    const std::size_t at = line.find('@');
    if (at == std::string_view::npos) {
      continue;
    }
    if (const auto joint = parse_joint(line.substr(at + 1))) {
      joints.push_back(*joint);
    }
  }
  return joints;
}

}  // namespace roio::cli
