/// PlainSetup and FixedSetup: what begin<>() makes of the chip of a plain node.
#ifndef ROIO_ARDUINO_SETUP_HPP
#define ROIO_ARDUINO_SETUP_HPP

#include <roio/mcp2515.hpp>

#if defined(__AVR__) && defined(__OPTIMIZE__)
#include <roio/arduino_setup_avr.hpp>
#else

namespace roio {

/// @tparam Cnf mcp2515::Cnf::word().
template <uint32_t Cnf>
class PlainSetup : public Mcp2515Config {
 public:
  PlainSetup(const Mcp2515FilterPair& filters, uint8_t control)
      : Mcp2515Config(Cnf, filters.mask, filters.filter[0], filters.filter[1], control) {}
};

/// The same for a node whose address is known when compiling.
template <uint32_t Cnf, uint8_t Subnet, uint8_t Node>
class FixedSetup : public PlainSetup<Cnf> {
 public:
  explicit FixedSetup(uint8_t control)
      : PlainSetup<Cnf>(mcp2515_filters_of(Address{Subnet, Node}), control) {}
};

}  // namespace roio

#endif

#endif
