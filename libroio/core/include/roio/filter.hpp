/// Filter programs: which identifiers a node wants, as (match, mask) pairs with what each one
/// means. A program knows no hardware; filter_mcp2515.hpp and filter_socketcan.hpp fit one to a
/// controller. Source: docs/protocol.md "Filters".
#ifndef ROIO_FILTER_HPP
#define ROIO_FILTER_HPP

#include <stdint.h>

#include <roio/header.hpp>
#include <roio/status.hpp>

namespace roio {

/// What a rule lets through, for people and for tools that print it. A rule merged from several
/// meanings has custom.
enum class FilterMeaning : uint8_t { own_address, broadcast, everything, custom };

/// Accepts the identifiers that equal match in every bit that is set in mask.
/// match has no bit outside mask; both lie in bits 28..0.
struct FilterRule {
  uint32_t match;
  uint32_t mask;
  FilterMeaning meaning;
};

constexpr bool accepts(const FilterRule& rule, uint32_t id) {
  return ((id ^ rule.match) & rule.mask) == 0;
}

/// Whether every identifier that `inner` accepts is accepted by `outer` too.
constexpr bool contains(const FilterRule& outer, const FilterRule& inner) {
  return (outer.mask & ~inner.mask) == 0 && accepts(outer, inner.match);
}

/// Whether some identifier is accepted by both.
constexpr bool overlaps(const FilterRule& a, const FilterRule& b) {
  return ((a.match ^ b.match) & a.mask & b.mask) == 0;
}

/// A list of rules; an identifier is accepted when any rule accepts it. Empty: nothing is.
/// Holds 12 bytes a rule on the host, 9 on AVR; no heap.
template <uint8_t Capacity>
class FilterProgram {
 public:
  FilterProgram() : size_(0), rules_() {}

  uint8_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const FilterRule& operator[](uint8_t index) const { return rules_[index]; }
  const FilterRule* begin() const { return rules_; }
  const FilterRule* end() const { return rules_ + size_; }
  void clear() { size_ = 0; }

  bool accepts(uint32_t id) const {
    for (const FilterRule& rule : *this) {
      if (roio::accepts(rule, id)) {
        return true;
      }
    }
    return false;
  }

  /// Adds one rule. A rule that adds nothing is left out, rules that it makes needless are dropped,
  /// and two rules that differ in one bit become one, so a program stays as short as plain merging
  /// gets it; what it accepts is exactly the union all the same.
  /// @return ok; bad_argument: match or mask reach above bit 28, or match has bits outside mask;
  ///         full: no room, the program is as it was.
  ROIO_NODISCARD Status add(FilterRule rule) {
    if (((rule.mask & ~id_mask) | (rule.match & ~rule.mask)) != 0) {
      return Status::bad_argument;
    }
    return insert(rule) ? Status::ok : Status::full;
  }

 private:
  // One pass per merge: each shortens the list or ends the loop, so at most size_ + 1 passes run.
  // What shortens the list makes room, too: a program found full has not been touched.
  bool insert(FilterRule rule) {
    for (uint8_t i = 0; i < size_;) {
      if (contains(rules_[i], rule)) {
        return true;
      }
      if (contains(rule, rules_[i])) {
        remove(i);
      } else if (differ_in_one_bit(rules_[i], rule)) {
        rule = join(rules_[i], rule);
        remove(i);
        i = 0;
      } else {
        ++i;
      }
    }
    if (size_ == Capacity) {
      return false;
    }
    rules_[size_++] = rule;
    return true;
  }

  static bool differ_in_one_bit(const FilterRule& a, const FilterRule& b) {
    const uint32_t difference = a.match ^ b.match;
    return a.mask == b.mask && (difference & (difference - 1U)) == 0;
  }

  static FilterRule join(const FilterRule& a, const FilterRule& b) {
    const uint32_t mask = a.mask & ~(a.match ^ b.match);
    return FilterRule{a.match & mask, mask,
                      a.meaning == b.meaning ? a.meaning : FilterMeaning::custom};
  }

  // Keeps the order of the others: earlier rules are the ones a fitting favours.
  void remove(uint8_t index) {
    --size_;
    for (uint8_t i = index; i < size_; ++i) {
      rules_[i] = rules_[i + 1];
    }
  }

  uint8_t size_;
  FilterRule rules_[Capacity];
};

/// A set of message classes, one bit each.
struct ClassSet {
  uint8_t bits;

  static constexpr ClassSet none() { return ClassSet{0}; }
  static constexpr ClassSet all() { return ClassSet{0x0F}; }
  constexpr bool has(MessageClass c) const { return (bits >> static_cast<uint8_t>(c)) & 1U; }
  constexpr ClassSet with(MessageClass c) const {
    return ClassSet{static_cast<uint8_t>(bits | (1U << static_cast<uint8_t>(c)))};
  }
};

/// What a node wants to hear.
struct Interest {
  Address own;                 ///< Messages to this address; a valid source address.
  uint32_t broadcast_subnets;  ///< Bit s set: broadcasts to subnet s.
  ClassSet classes;            ///< Only these classes; all() also lets the reserved one be counted.
  bool everything;             ///< Every identifier of these classes, whoever it is for.
};

/// A plain node: its own address, and broadcasts to its own subnet, in every class.
constexpr Interest interest_of(Address own) {
  return Interest{own, UINT32_C(1) << (own.subnet & max_subnet), ClassSet::all(), false};
}

namespace detail {

/// Adds `rule` once for each class wanted; classes that lie side by side become one rule in add().
template <uint8_t Capacity>
Status add_for_classes(FilterProgram<Capacity>& program, const FilterRule& rule, ClassSet classes) {
  if ((classes.bits & 0x0FU) == 0x0FU) {
    return program.add(rule);
  }
  for (uint8_t c = 0; c <= uint8_t{ClassField::largest()}; ++c) {
    if (!classes.has(static_cast<MessageClass>(c))) {
      continue;
    }
    const Status status = program.add(
        FilterRule{rule.match | ClassField::put(c), rule.mask | ClassField::mask(), rule.meaning});
    if (status != Status::ok) {
      return status;
    }
  }
  return Status::ok;
}

constexpr FilterRule destination_rule(Address destination, FilterMeaning meaning) {
  return FilterRule{
      DestinationSubnetField::put(destination.subnet) | DestinationNodeField::put(destination.node),
      DestinationSubnetField::mask() | DestinationNodeField::mask(), meaning};
}

}  // namespace detail

/// Computes the program for what a node wants; the own address comes first.
/// @param program replaced on ok, untouched otherwise.
/// @return ok; bad_argument: own is no valid source address; full: Capacity rules do not suffice.
template <uint8_t Capacity>
ROIO_NODISCARD Status compile(const Interest& interest, FilterProgram<Capacity>& program) {
  if (!is_valid_source(interest.own)) {
    return Status::bad_argument;
  }
  FilterProgram<Capacity> compiled;
  Status status = Status::ok;
  if (interest.everything) {
    status = detail::add_for_classes(compiled, FilterRule{0, 0, FilterMeaning::everything},
                                     interest.classes);
  } else {
    status = detail::add_for_classes(
        compiled, detail::destination_rule(interest.own, FilterMeaning::own_address),
        interest.classes);
    for (uint8_t subnet = 0; subnet <= max_subnet && status == Status::ok; ++subnet) {
      if ((interest.broadcast_subnets >> subnet) & 1U) {
        status = detail::add_for_classes(
            compiled, detail::destination_rule(broadcast_of(subnet), FilterMeaning::broadcast),
            interest.classes);
      }
    }
  }
  if (status == Status::ok) {
    program = compiled;
  }
  return status;
}

}  // namespace roio

#endif
