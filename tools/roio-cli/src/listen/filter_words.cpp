#include "listen/filter_words.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <roio/header.hpp>
#include <string_view>

namespace roio::cli {
namespace {

// The tagged identifiers that equal match in every bit set in mask; match lies inside mask.
struct Cube {
  std::uint32_t match;
  std::uint32_t mask;
};
using Cubes = std::vector<Cube>;

constexpr Cube every_frame{0, 0};
constexpr Cube extended_data{socketcan::extended_flag,
                             socketcan::extended_flag | socketcan::remote_flag};

// While the choices of a group are multiplied out, more than this is given up: the product would
// never come down to what a bus takes.
constexpr std::size_t max_cubes = 4 * max_kernel_filters;

enum Kind : std::uint8_t { to, from, priority, message_class, identifier, kind_count };

// What stands between two "or".
struct Group {
  std::array<Cubes, kind_count> wanted;
  Cubes unwanted;
};

bool contains(const Cube& outer, const Cube& inner) {
  return (outer.mask & ~inner.mask) == 0 && ((outer.match ^ inner.match) & outer.mask) == 0;
}

// No standard frame has an identifier bit above the 11th. The kernel overlooks those bits instead.
bool is_impossible(const Cube& cube) {
  const bool standard_only = (cube.mask & ~cube.match & socketcan::extended_flag) != 0;
  return standard_only && (cube.match & id_mask & ~max_id(FrameKind::standard)) != 0;
}

std::optional<Cube> intersection(const Cube& a, const Cube& b) {
  if (((a.match ^ b.match) & a.mask & b.mask) != 0) {
    return std::nullopt;
  }
  const Cube both{a.match | b.match, a.mask | b.mask};
  return is_impossible(both) ? std::nullopt : std::optional(both);
}

void insert(Cubes& cubes, const Cube& cube) {
  const auto holds_it = [&](const Cube& other) { return contains(other, cube); };
  if (std::any_of(cubes.begin(), cubes.end(), holds_it)) {
    return;
  }
  std::erase_if(cubes, [&](const Cube& other) { return contains(cube, other); });
  cubes.push_back(cube);
}

// @return nothing when it comes to more than max_cubes.
std::optional<Cubes> product(const Cubes& left, const Cubes& right) {
  Cubes all;
  for (const Cube& a : left) {
    for (const Cube& b : right) {
      if (const auto both = intersection(a, b)) {
        insert(all, *both);
      }
    }
    if (all.size() > max_cubes) {
      return std::nullopt;
    }
  }
  return all;
}

// Whatever differs from the cube differs in one of the bits that it cares about.
Cubes complement(const Cube& cube) {
  Cubes all;
  for (std::uint32_t open = cube.mask; open != 0; open &= open - 1U) {
    const std::uint32_t bit = open & (~open + 1U);
    all.push_back({~cube.match & bit, bit});
  }
  return all;
}

ParseError bad_word(std::string_view word, std::string_view why) {
  return {"bad filter " + quote(word) + ": " + std::string(why), 0};
}

constexpr std::string_view expected_words =
    "expected to=SUBNET.NODE, from=SUBNET.NODE, urgent, normal, class=message|system|stream, "
    "ID:MASK, ID~MASK or the word or";

template <typename Field>
Cube field_cube(std::uint32_t value) {
  return {extended_data.match | Field::put(value), extended_data.mask | Field::mask()};
}

template <typename SubnetField, typename NodeField>
Cube address_cube(Address address, bool any_node) {
  Cube cube = field_cube<SubnetField>(address.subnet);
  if (!any_node) {
    cube.match |= NodeField::put(address.node);
    cube.mask |= NodeField::mask();
  }
  return cube;
}

// "0.*" is the broadcast address, which no node has for its own; "0.any" is every node.
Parsed<Cube> parse_address_cube(std::string_view text, bool is_source) {
  constexpr std::string_view any = ".any";
  const bool any_node = text.ends_with(any);
  const Parsed<Address> address = parse_address(
      any_node ? std::string(text.substr(0, text.size() - any.size())) + ".*" : std::string(text));
  if (!address) {
    return address.error();
  }
  if (is_source && is_broadcast(*address) && !any_node) {
    return ParseError{quote(text) +
                          " is the broadcast address, which nobody sends from; expected " +
                          std::to_string(address->subnet) + ".any for any node of the subnet",
                      0};
  }
  if (is_source) {
    return address_cube<SourceSubnetField, SourceNodeField>(*address, any_node);
  }
  return address_cube<DestinationSubnetField, DestinationNodeField>(*address, any_node);
}

std::optional<std::uint32_t> parse_hex_word(std::string_view text) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole && text.size() <= 8 ? std::optional(value) : std::nullopt;
}

// As candump reads them: 8 digits make the identifier an extended one. What no frame has, candump
// takes too, and then shows nothing.
Parsed<Cube> parse_identifier_cube(std::string_view id_text, std::string_view mask_text) {
  const auto id = parse_hex_word(id_text);
  const auto mask = parse_hex_word(mask_text);
  if (!id || !mask) {
    return ParseError{
        "expected an identifier and a mask of 1 to 8 hexadecimal digits each, such as 123:7FF or "
        "1004A00A~1FFFFFFF",
        0};
  }
  constexpr std::uint32_t kind_bits = socketcan::extended_flag | socketcan::remote_flag;
  const bool extended = id_text.size() == 8;
  const std::uint32_t largest = max_id(extended ? FrameKind::extended : FrameKind::standard);
  if (*id > largest) {
    return ParseError{"identifier " + std::string(id_text) + " is out of range; expected " +
                          (extended ? "00000000..1FFFFFFF" : "0..7FF, or 8 digits (extended)"),
                      0};
  }
  if ((*mask & ~kind_bits) > largest) {
    return ParseError{
        "mask " + std::string(mask_text) + " is out of range; expected " +
            (extended ? "0..1FFFFFFF" : "0..7FF beside an identifier below 8 digits") +
            ", plus 80000000 and 40000000 for the kind of frame",
        0};
  }
  const std::uint32_t tagged = *id | (extended ? socketcan::extended_flag : 0U);
  return Cube{tagged & *mask, *mask};
}

std::optional<ParseError> add_identifier(Group& group, std::string_view word, std::size_t sign) {
  const auto cube = parse_identifier_cube(word.substr(0, sign), word.substr(sign + 1));
  if (!cube) {
    return bad_word(word, cube.error().message);
  }
  (word[sign] == '~' ? group.unwanted : group.wanted[identifier]).push_back(*cube);
  return std::nullopt;
}

std::optional<ParseError> add_address(Group& group, std::string_view word, Kind kind) {
  const auto cube = parse_address_cube(word.substr(word.find('=') + 1), kind == from);
  if (!cube) {
    return bad_word(word, cube.error().message);
  }
  group.wanted[kind].push_back(*cube);
  return std::nullopt;
}

std::optional<ParseError> add_class(Group& group, std::string_view word) {
  const auto parsed = parse_class(word.substr(word.find('=') + 1));
  if (!parsed) {
    return bad_word(word, parsed.error().message);
  }
  const auto value = static_cast<std::uint32_t>(*parsed);
  group.wanted[message_class].push_back(field_cube<ClassField>(value));
  return std::nullopt;
}

std::optional<ParseError> add_word(Group& group, std::string_view word) {
  if (word.starts_with("to=")) {
    return add_address(group, word, to);
  }
  if (word.starts_with("from=")) {
    return add_address(group, word, from);
  }
  if (word.starts_with("class=")) {
    return add_class(group, word);
  }
  if (word == "urgent" || word == "normal") {
    const auto value = word == "urgent" ? Priority::urgent : Priority::normal;
    group.wanted[priority].push_back(field_cube<PriorityField>(static_cast<std::uint32_t>(value)));
    return std::nullopt;
  }
  if (const std::size_t sign = word.find_first_of(":~"); sign != std::string_view::npos) {
    return add_identifier(group, word, sign);
  }
  return bad_word(word, expected_words);
}

Parsed<std::vector<Group>> parse_groups(std::span<const std::string> words) {
  std::vector<Group> groups(1);
  bool open = words.empty();  // whether the group so far may end here
  for (const std::string& word : words) {
    if (word == "or") {
      if (!open) {
        break;
      }
      groups.emplace_back();
      open = false;
      continue;
    }
    if (auto error = add_word(groups.back(), word)) {
      return *std::move(error);
    }
    open = true;
  }
  if (!open) {
    return bad_word("or", "expected a filter on either side of it");
  }
  return groups;
}

// @return nothing when it comes to more than max_cubes.
std::optional<Cubes> multiply_out(const Group& group, const Cube& all_of_it) {
  std::optional<Cubes> cubes = Cubes{all_of_it};
  for (const Cubes& choices : group.wanted) {
    if (cubes && !choices.empty()) {
      cubes = product(*cubes, choices);
    }
  }
  for (const Cube& unwanted : group.unwanted) {
    if (cubes) {
      cubes = product(*cubes, complement(unwanted));
    }
  }
  return cubes;
}

// One ID~MASK alone is a filter of the kernel's as it stands.
std::optional<SocketCanFilter> as_inverted(const std::vector<Group>& groups) {
  const Group& group = groups.front();
  const bool only_unwanted = std::all_of(group.wanted.begin(), group.wanted.end(),
                                         [](const Cubes& cubes) { return cubes.empty(); });
  if (groups.size() > 1 || !only_unwanted || group.unwanted.size() != 1 ||
      group.unwanted[0].mask == 0 || is_impossible(group.unwanted[0])) {
    return std::nullopt;
  }
  return SocketCanFilter{group.unwanted[0].match | socketcan::inverted, group.unwanted[0].mask};
}

ParseError too_many() {
  return {"these filters are too many: they come to more than " +
              std::to_string(max_kernel_filters) +
              " (identifier, mask) pairs; expected fewer words",
          0};
}

}  // namespace

Parsed<std::vector<SocketCanFilter>> compile_filter_words(std::span<const std::string> words,
                                                          bool roio_only) {
  const auto groups = parse_groups(words);
  if (!groups) {
    return groups.error();
  }
  if (const auto inverted = as_inverted(*groups); inverted && !roio_only) {
    return std::vector{*inverted};
  }
  Cubes all;
  for (const Group& group : *groups) {
    const auto cubes = multiply_out(group, roio_only ? extended_data : every_frame);
    if (!cubes || all.size() > max_cubes) {
      return too_many();
    }
    for (const Cube& cube : *cubes) {
      insert(all, cube);
    }
  }
  if (all.empty()) {
    return ParseError{"no frame can satisfy these filters together; put \"or\" between choices", 0};
  }
  if (all.size() > max_kernel_filters) {
    return too_many();
  }
  std::vector<SocketCanFilter> filters(all.size());
  std::transform(all.begin(), all.end(), filters.begin(), [](const Cube& cube) {
    return SocketCanFilter{cube.match, cube.mask};
  });
  return filters;
}

}  // namespace roio::cli
