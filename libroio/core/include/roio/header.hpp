/// Header: the 29 bits of an extended CAN identifier, read as a Roio header.
///
///    28 | 27..26 | 25......21 | 20.......13 | 12.......8 | 7........0
///   prio| class  | dst subnet |  dst node   | src subnet |  src node
///
/// Bit 28 is the first on the wire and 0 is dominant, so the smaller number wins arbitration:
/// urgent before normal, then the lower class, destination and source.
/// Pure functions, no state; usable from an interrupt. Source: docs/protocol.md "Header".
#ifndef ROIO_HEADER_HPP
#define ROIO_HEADER_HPP

#include <stdint.h>

#include <roio/address.hpp>
#include <roio/status.hpp>

namespace roio {

enum class Priority : uint8_t { urgent = 0, normal = 1 };

enum class MessageClass : uint8_t {
  message = 0,   ///< The user's own 0..8 bytes.
  system = 1,    ///< Plug-and-play, heartbeat, bindings.
  stream = 2,    ///< Segments of messages longer than 8 bytes.
  reserved = 3,  ///< Never sent; ignored and counted on receive.
};

struct Header {
  Priority priority;
  MessageClass message_class;
  Address destination;
  Address source;
};

constexpr bool operator==(const Header& a, const Header& b) {
  return a.priority == b.priority && a.message_class == b.message_class &&
         a.destination == b.destination && a.source == b.source;
}
constexpr bool operator!=(const Header& a, const Header& b) {
  return !(a == b);
}

/// One field of the identifier: where it lies, and how a value gets in and out.
template <uint8_t Lsb, uint8_t Width>
struct IdField {
  static_assert(Width > 0 && Width <= 8 && Lsb + Width <= 29, "a field lies in bits 28..0");
  static constexpr uint8_t lsb = Lsb;
  static constexpr uint8_t width = Width;
  static constexpr uint32_t largest() { return (UINT32_C(1) << Width) - 1U; }
  static constexpr uint32_t mask() { return largest() << Lsb; }
  static constexpr uint32_t put(uint32_t value) { return (value & largest()) << Lsb; }
  /// Whole bytes first, and the rest in 16 bits: an AVR shifts a long word one bit at a time.
  static constexpr uint32_t get(uint32_t id) {
    return (static_cast<uint16_t>(id >> (Lsb & 0x18U)) >> (Lsb & 7U)) & largest();
  }
};

using PriorityField = IdField<28, 1>;
using ClassField = IdField<26, 2>;
using DestinationSubnetField = IdField<21, 5>;
using DestinationNodeField = IdField<13, 8>;
using SourceSubnetField = IdField<8, 5>;
using SourceNodeField = IdField<0, 8>;

constexpr uint32_t id_mask = UINT32_C(0x1FFFFFFF);  ///< The 29 bits of an extended identifier.

static_assert((PriorityField::mask() | ClassField::mask() | DestinationSubnetField::mask() |
               DestinationNodeField::mask() | SourceSubnetField::mask() |
               SourceNodeField::mask()) == id_mask,
              "the fields fill the identifier");
static_assert(PriorityField::width + ClassField::width + DestinationSubnetField::width +
                      DestinationNodeField::width + SourceSubnetField::width +
                      SourceNodeField::width ==
                  29,
              "no two fields share a bit");

/// Whether every field is in range for sending: subnets 0..31, source node 0..254, class not
/// reserved.
constexpr bool is_valid(const Header& header) {
  return static_cast<uint8_t>(header.priority) <= PriorityField::largest() &&
         static_cast<uint8_t>(header.message_class) <
             static_cast<uint8_t>(MessageClass::reserved) &&
         is_valid_destination(header.destination) && is_valid_source(header.source);
}

/// Packs a header whose fields are in range; bits outside a field's width are cut off.
/// Use make_id() for values that come from outside.
constexpr uint32_t pack_id(const Header& header) {
  return PriorityField::put(static_cast<uint8_t>(header.priority)) |
         ClassField::put(static_cast<uint8_t>(header.message_class)) |
         DestinationSubnetField::put(header.destination.subnet) |
         DestinationNodeField::put(header.destination.node) |
         SourceSubnetField::put(header.source.subnet) | SourceNodeField::put(header.source.node);
}

/// Reads any 29-bit identifier as a header; bits 31..29 are ignored. The result need not be one
/// that may be sent: ask is_valid().
constexpr Header unpack_id(uint32_t id) {
  return Header{static_cast<Priority>(PriorityField::get(id)),
                static_cast<MessageClass>(ClassField::get(id)),
                Address{static_cast<uint8_t>(DestinationSubnetField::get(id)),
                        static_cast<uint8_t>(DestinationNodeField::get(id))},
                Address{static_cast<uint8_t>(SourceSubnetField::get(id)),
                        static_cast<uint8_t>(SourceNodeField::get(id))}};
}

/// Packs a header after checking each field.
/// @param id written on success only.
/// @return ok; bad_argument when is_valid(header) is false.
ROIO_NODISCARD inline Status make_id(const Header& header, uint32_t& id) {
  if (!is_valid(header)) {
    return Status::bad_argument;
  }
  id = pack_id(header);
  return Status::ok;
}

}  // namespace roio

#endif
