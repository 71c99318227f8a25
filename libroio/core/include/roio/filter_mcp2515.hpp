/// Fits a filter program to the MCP2515's acceptance hardware: two masks and six filters.
///
///   receive buffer   mask    filters
///   RXB0             RXM0    RXF0 RXF1
///   RXB1             RXM1    RXF2 RXF3 RXF4 RXF5
///
/// A filter accepts the identifiers that equal it in every bit that its buffer's mask has set.
/// Filters cannot be switched off, so an unused one repeats a used one. A frame that RXB0 accepts
/// may roll over into RXB1 whatever RXB1's filters say; so what fits in RXB0's filters has two
/// buffers to itself, and its order can be told: RXB1 is filled only while RXB0 is full. A frame
/// that RXB1 alone accepts may come before or after the one found in RXB0, and nothing says which.
/// Source: MCP2515 datasheet DS20001801, 4.5 "Message Acceptance Filters and Masks", registers
/// RXFnSIDH..RXMnEID0.
#ifndef ROIO_FILTER_MCP2515_HPP
#define ROIO_FILTER_MCP2515_HPP

#include <stdint.h>

#include <roio/filter.hpp>

namespace roio {

/// The register image, ready to be written: each filter or mask as SIDH, SIDL, EID8, EID0.
struct Mcp2515Filters {
  static constexpr uint8_t mask_count = 2;
  static constexpr uint8_t filter_count = 6;
  static constexpr uint8_t exide = 0x08;  ///< In a filter's SIDL: extended identifiers only.

  uint8_t mask[mask_count][4];
  uint8_t filter[filter_count][4];
  bool exact;     ///< False: the chip lets through more than the program, and software must check.
  bool in_order;  ///< Whether RXB0 accepts all that RXB1 does, so that a driver can keep the order.

  static constexpr uint8_t mask_of(uint8_t filter) { return filter < 2 ? 0 : 1; }
};

/// One mask and two filters for RXB0, which RXB1 repeats: what a driver needs to keep the order of
/// frames. As identifiers; mcp2515_register() makes registers of them.
struct Mcp2515FilterPair {
  static constexpr uint32_t extended_only = UINT32_C(1) << 31;  ///< In a filter: EXIDE.

  uint32_t mask;
  uint32_t filter[2];
  bool exact;  ///< As in Mcp2515Filters.

  /// The image: the second filter in RXF1, the first in all others.
  operator Mcp2515Filters() const;
};

/// The 29 bits of an identifier (or mask) as the chip keeps them, EXIDE clear:
///   SIDH 7..0 = id 28..21 | SIDL 7..5 = id 20..18, 1..0 = id 17..16 | EID8 = id 15..8 | EID0 =
///   id 7..0
/// Byte by byte, since an AVR shifts a long word one bit at a time.
inline void to_mcp2515_registers(uint32_t id, uint8_t registers[4]) {
  const uint8_t high = static_cast<uint8_t>(id >> 24);
  const uint8_t middle = static_cast<uint8_t>(id >> 16);
  registers[0] = static_cast<uint8_t>((high << 3) | (middle >> 5));
  registers[1] = static_cast<uint8_t>(((middle << 3) & 0xE0) | (middle & 0x03));
  registers[2] = static_cast<uint8_t>(id >> 8);
  registers[3] = static_cast<uint8_t>(id);
}

/// The same for one register: 0..3 for SIDH, SIDL, EID8, EID0; bit 31 becomes EXIDE. For constants.
constexpr uint8_t mcp2515_register(uint32_t tagged_id, uint8_t index) {
  return index == 0 ? static_cast<uint8_t>(tagged_id >> 21)
         : index == 1
             ? static_cast<uint8_t>(((tagged_id >> 13) & 0xE0U) | ((tagged_id >> 16) & 0x03U) |
                                    ((tagged_id >> 28) & Mcp2515Filters::exide))
         : index == 2 ? static_cast<uint8_t>(tagged_id >> 8)
                      : static_cast<uint8_t>(tagged_id);
}

/// The inverse of to_mcp2515_registers(); other bits of SIDL are ignored.
inline uint32_t from_mcp2515_registers(const uint8_t registers[4]) {
  const uint8_t high = static_cast<uint8_t>(registers[0] >> 3);
  const uint8_t middle = static_cast<uint8_t>((registers[0] << 5) | ((registers[1] >> 3) & 0x1C) |
                                              (registers[1] & 0x03));
  return (static_cast<uint32_t>(high) << 24) | (static_cast<uint32_t>(middle) << 16) |
         (static_cast<uint32_t>(registers[2]) << 8) | registers[3];
}

/// Whether the chip, so set, accepts an extended frame with this identifier.
inline bool accepts(const Mcp2515Filters& image, uint32_t id) {
  for (uint8_t f = 0; f < Mcp2515Filters::filter_count; ++f) {
    const uint32_t mask = from_mcp2515_registers(image.mask[Mcp2515Filters::mask_of(f)]);
    if (((id ^ from_mcp2515_registers(image.filter[f])) & mask) == 0) {
      return true;
    }
  }
  return false;
}

namespace detail {

/// Whether the rules accept every identifier that `cube` accepts. Narrows the cube to what the
/// first rule that overlaps it accepts, bit by bit; what each step cuts off is left to the rules
/// after that one, so the depth is at most the number of rules.
inline bool covered(FilterRule cube, const FilterRule* rules, const FilterRule* end) {
  while (rules != end && !overlaps(*rules, cube)) {
    ++rules;
  }
  if (rules == end) {
    return false;
  }
  for (uint32_t open = rules->mask & ~cube.mask; open != 0; open &= open - 1U) {
    const uint32_t bit = open & (~open + 1U);
    cube.mask |= bit;
    cube.match |= ~rules->match & bit;
    if (!covered(cube, rules + 1, end)) {
      return false;
    }
    cube.match ^= bit;
  }
  return true;
}

/// Searches the way to share out the rules among the six filters that lets the fewest identifiers
/// through. Exhaustive with pruning over at most max_rules rules.
class Mcp2515Search {
 public:
  static constexpr uint8_t max_rules = 8;

  Mcp2515Search(const FilterRule* rules, uint8_t count)
      : rules_(rules), count_(count), best_cost_(UINT32_MAX), used_(), match_(), slot_(), best_() {
    const uint32_t masks[2] = {id_mask, id_mask};
    place(0, masks);
  }

  /// Which filter 0..5 the best way found puts a rule in.
  uint8_t filter_of(uint8_t rule) const { return best_[rule]; }

 private:
  static uint8_t first_filter(uint8_t buffer) { return buffer == 0 ? 0 : 2; }
  static uint8_t room(uint8_t buffer) { return buffer == 0 ? 2 : 4; }

  static uint32_t accepted_by(uint32_t mask) {
    uint32_t ids = 1;
    for (uint32_t open = ~mask & id_mask; open != 0; open &= open - 1U) {
      ids <<= 1;
    }
    return ids;
  }

  // How many identifiers get through. Filters behind one mask share none, so only what both buffers
  // accept must be taken off again. (Two equal filters count twice; the way that has one in their
  // place is tried, too, and costs less.) At most 6 * 2^29 on the way: fits in 32 bits. Not
  // inlined, to keep its variables out of the stack frames of the recursion.
  __attribute__((noinline)) uint32_t cost(const uint32_t masks[2]) const {
    uint32_t ids = used_[0] * accepted_by(masks[0]) + used_[1] * accepted_by(masks[1]);
    for (uint8_t i = 0; i < used_[0]; ++i) {
      for (uint8_t j = 0; j < used_[1]; ++j) {
        if (((match_[i] ^ match_[first_filter(1) + j]) & masks[0] & masks[1]) == 0) {
          ids -= accepted_by(masks[0] | masks[1]);
        }
      }
    }
    return ids;
  }

  // A placement only ever widens masks or takes another filter, so its cost bounds all that follow.
  void place(uint8_t rule, const uint32_t masks[2]) {
    if (cost(masks) >= best_cost_) {
      return;
    }
    if (rule == count_) {
      best_cost_ = cost(masks);
      for (uint8_t i = 0; i < count_; ++i) {
        best_[i] = slot_[i];
      }
      return;
    }
    for (uint8_t buffer = 0; buffer < 2; ++buffer) {
      for (uint8_t i = 0; i < used_[buffer]; ++i) {
        share(rule, masks, buffer, static_cast<uint8_t>(first_filter(buffer) + i));
      }
      if (used_[buffer] < room(buffer)) {
        const uint8_t filter = static_cast<uint8_t>(first_filter(buffer) + used_[buffer]);
        match_[filter] = rules_[rule].match;
        ++used_[buffer];
        share(rule, masks, buffer, filter);
        --used_[buffer];
      }
    }
  }

  // Rules in one filter: the mask loses the bits in which they differ.
  void share(uint8_t rule, const uint32_t masks[2], uint8_t buffer, uint8_t filter) {
    uint32_t next[2] = {masks[0], masks[1]};
    next[buffer] &= rules_[rule].mask & ~(match_[filter] ^ rules_[rule].match);
    slot_[rule] = filter;
    place(static_cast<uint8_t>(rule + 1U), next);
  }

  const FilterRule* rules_;
  uint8_t count_;
  uint32_t best_cost_;
  uint8_t used_[2];
  uint32_t match_[Mcp2515Filters::filter_count];
  uint8_t slot_[max_rules];
  uint8_t best_[max_rules];
};

/// The tightest single rule that contains both.
inline FilterRule hull(const FilterRule& a, const FilterRule& b) {
  const uint32_t mask = a.mask & b.mask & ~(a.match ^ b.match);
  return FilterRule{a.match & mask, mask, FilterMeaning::custom};
}

inline uint8_t open_bits(const FilterRule& rule) {
  uint8_t bits = 0;
  for (uint32_t open = ~rule.mask & id_mask; open != 0; open &= open - 1U) {
    ++bits;
  }
  return bits;
}

/// Joins the two rules whose hull is smallest, until `limit` are left.
inline uint8_t shorten(FilterRule* rules, uint8_t count, uint8_t limit) {
  while (count > limit) {
    uint8_t first = 0;
    uint8_t second = 1;
    for (uint8_t i = 0; i < count; ++i) {
      for (uint8_t j = static_cast<uint8_t>(i + 1U); j < count; ++j) {
        if (open_bits(hull(rules[i], rules[j])) < open_bits(hull(rules[first], rules[second]))) {
          first = i;
          second = j;
        }
      }
    }
    rules[first] = hull(rules[first], rules[second]);
    rules[second] = rules[--count];
  }
  return count;
}

/// An identifier that no node sends (reserved class, source 255): what a chip that is to receive
/// nothing listens for.
constexpr FilterRule nobody() {
  return FilterRule{ClassField::mask() | SourceNodeField::mask(), id_mask, FilterMeaning::custom};
}

/// Fills in `exact` and `in_order` from the registers.
inline void judge(Mcp2515Filters& image, const FilterRule* begin, const FilterRule* end) {
  FilterRule accepted[Mcp2515Filters::filter_count];
  image.exact = true;
  for (uint8_t f = 0; f < Mcp2515Filters::filter_count; ++f) {
    const uint32_t mask = from_mcp2515_registers(image.mask[Mcp2515Filters::mask_of(f)]);
    accepted[f] =
        FilterRule{from_mcp2515_registers(image.filter[f]) & mask, mask, FilterMeaning::custom};
    image.exact = image.exact && covered(accepted[f], begin, end);
  }
  image.in_order = true;
  for (uint8_t f = 2; f < Mcp2515Filters::filter_count; ++f) {
    image.in_order = image.in_order && covered(accepted[f], accepted, accepted + 2);
  }
}

constexpr Mcp2515FilterPair filter_pair(uint32_t mask, uint32_t first, uint32_t second) {
  return Mcp2515FilterPair{mask,
                           {(first & mask) | Mcp2515FilterPair::extended_only,
                            (second & mask) | Mcp2515FilterPair::extended_only},
                           true};
}

/// The mask that is left when rules are shared out over two filters: bit r of `second` puts rule r
/// in the second one. A filter cannot compare the bits in which its rules differ.
inline uint32_t shared_mask(const FilterRule* rules, uint8_t count, uint8_t second) {
  uint32_t mask = id_mask;
  const FilterRule* first_of[2] = {nullptr, nullptr};
  for (uint8_t r = 0; r < count; ++r) {
    const FilterRule*& first = first_of[(static_cast<unsigned>(second) >> r) & 1U];
    if (first == nullptr) {
      first = &rules[r];
    }
    mask &= rules[r].mask & ~(rules[r].match ^ first->match);
  }
  return mask;
}

/// Copies a program's rules to be shared out: one at least, and no more than a search looks at.
/// @param rules room for Capacity of them, and for one.
/// @return how many there are.
template <uint8_t Capacity>
uint8_t rules_to_fit(const FilterProgram<Capacity>& program, FilterRule* rules) {
  uint8_t count = 0;
  for (const FilterRule& rule : program) {
    rules[count++] = rule;
  }
  if (count == 0) {
    rules[count++] = nobody();
  }
  return Capacity > Mcp2515Search::max_rules ? shorten(rules, count, Mcp2515Search::max_rules)
                                             : count;
}

}  // namespace detail

/// Fits a program to the chip. Never rejects what the program accepts; where six filters behind two
/// masks cannot say it exactly, lets through as few more identifiers as can be with each rule whole
/// in one filter, for up to 8 rules; a longer program has its closest rules joined first. An empty
/// program accepts one identifier that nobody sends (the chip cannot accept none).
/// Cost: 9 ways looked at for a plain node's two rules, some 500 for rules that fit, over 10,000
/// for eight that do not. Recursive: on AVR 350 bytes of stack for two rules, 650 for eight.
/// No heap.
template <uint8_t Capacity>
Mcp2515Filters fit_mcp2515(const FilterProgram<Capacity>& program) {
  FilterRule rules[Capacity == 0 ? 1 : Capacity];
  const uint8_t count = detail::rules_to_fit(program, rules);
  const detail::Mcp2515Search search(rules, count);

  FilterRule slots[Mcp2515Filters::filter_count];
  bool used[Mcp2515Filters::filter_count] = {};
  for (uint8_t i = 0; i < count; ++i) {
    const uint8_t f = search.filter_of(i);
    slots[f] = used[f] ? detail::hull(slots[f], rules[i]) : rules[i];
    used[f] = true;
  }
  uint32_t masks[Mcp2515Filters::mask_count] = {id_mask, id_mask};
  for (uint8_t f = 0; f < Mcp2515Filters::filter_count; ++f) {
    if (used[f]) {
      masks[Mcp2515Filters::mask_of(f)] &= slots[f].mask;
    }
  }
  if (!used[2]) {
    masks[1] = masks[0];
  }

  Mcp2515Filters image;
  for (uint8_t m = 0; m < Mcp2515Filters::mask_count; ++m) {
    to_mcp2515_registers(masks[m], image.mask[m]);
  }
  for (uint8_t f = 0; f < Mcp2515Filters::filter_count; ++f) {
    // RXB0's first filter is always used; RXB1's first, when any of RXB1's is.
    const uint8_t source = used[f] ? f : f >= 2 && used[2] ? uint8_t{2} : uint8_t{0};
    to_mcp2515_registers(slots[source].match & masks[Mcp2515Filters::mask_of(f)], image.filter[f]);
    image.filter[f][1] |= Mcp2515Filters::exide;
  }
  detail::judge(image, program.begin(), program.end());
  return image;
}

/// Fits a program to RXB0's two filters, and repeats them in RXB1: what a driver needs to keep the
/// order of frames. Never rejects what the program accepts; where two filters behind one mask
/// cannot say it exactly, lets through as few more identifiers as can be with each rule whole in
/// one filter, for up to 8 rules; a longer program has its closest rules joined first. An empty
/// program accepts one identifier that nobody sends. At most 128 ways are looked at; no heap, no
/// recursion but for `exact`.
template <uint8_t Capacity>
Mcp2515FilterPair fit_mcp2515_in_order(const FilterProgram<Capacity>& program) {
  FilterRule rules[Capacity == 0 ? 1 : Capacity];
  const uint8_t count = detail::rules_to_fit(program, rules);
  // Rule 0 is in the first filter: the other half of the ways are the same with names changed. Two
  // filters accept twice as much as one behind the same mask.
  uint8_t best = 0;
  uint32_t fewest = UINT32_MAX;
  const uint8_t ways = static_cast<uint8_t>(1U << (count - 1U));
  for (uint8_t half = 0; half < ways; ++half) {
    const uint8_t second = static_cast<uint8_t>(half << 1);
    const FilterRule shared = {0, detail::shared_mask(rules, count, second), FilterMeaning::custom};
    const uint32_t accepted = (UINT32_C(1) << detail::open_bits(shared)) << (second != 0 ? 1 : 0);
    if (accepted < fewest) {
      fewest = accepted;
      best = second;
    }
  }
  uint8_t other = 0;
  while (best != 0 && ((static_cast<unsigned>(best) >> other) & 1U) == 0) {
    ++other;
  }
  Mcp2515FilterPair pair = detail::filter_pair(detail::shared_mask(rules, count, best),
                                               rules[0].match, rules[other].match);
  Mcp2515Filters image = pair;
  detail::judge(image, program.begin(), program.end());
  pair.exact = image.exact;
  return pair;
}

/// The filters of a plain node: its own address, and broadcasts to its own subnet. Accepts
/// what interest_of(own), compiled and fitted, does, for a fraction of the flash.
/// @param own a valid source address; of another one the low bits are taken.
constexpr Mcp2515FilterPair mcp2515_filters_of(Address own) {
  return detail::filter_pair(
      DestinationSubnetField::mask() | DestinationNodeField::mask(),
      DestinationSubnetField::put(own.subnet) | DestinationNodeField::put(own.node),
      DestinationSubnetField::put(own.subnet) | DestinationNodeField::put(broadcast_node));
}

/// The filters that let every frame through, standard and remote ones, too: for a sniffer. They
/// compare nothing; RXM = 11 would also hand out the beginnings of broken frames. Without EXIDE a
/// filter takes standard frames only, so one of each kind is needed.
constexpr Mcp2515FilterPair mcp2515_filters_of_everything() {
  return Mcp2515FilterPair{0, {0, Mcp2515FilterPair::extended_only}, true};
}

inline Mcp2515FilterPair::operator Mcp2515Filters() const {
  Mcp2515Filters image;
  for (uint8_t byte = 0; byte < 4; ++byte) {
    image.mask[0][byte] = image.mask[1][byte] = mcp2515_register(mask, byte);
    for (uint8_t f = 0; f < Mcp2515Filters::filter_count; ++f) {
      image.filter[f][byte] = mcp2515_register(filter[f == 1 ? 1 : 0], byte);
    }
  }
  image.exact = exact;
  image.in_order = true;
  return image;
}

}  // namespace roio

#endif
