// The whole driver, every member of it, for an AVR: the test looks at what the object file asks
// for.
#include <roio/mcp2515.hpp>

// Of external linkage, or the compiler would leave all of it out.

/// As small as a port can be: SPI by its registers, chip select on a pin of port B.
struct Port {
  static constexpr bool has_interrupt_line = true;
  bool interrupt_line_is_low();
  void pause(uint16_t microseconds);
  uint32_t microseconds();

  class Transaction {
   public:
    Transaction(Port&, uint8_t first) {
      select(true);
      put(first);
    }
    ~Transaction() { release(); }
    void put(uint8_t byte) { exchange(byte); }
    uint8_t exchange(uint8_t byte);
    void send(const uint8_t* bytes, uint8_t count);
    uint8_t* receive(uint8_t* bytes, uint8_t count);
    void release() { select(false); }
    void restart(uint8_t first) {
      select(true);
      put(first);
    }

   private:
    static void select(bool selected);
  };

  class Uninterrupted {
   public:
    explicit Uninterrupted(Port&) { __asm__ __volatile__("cli" ::: "memory"); }
    ~Uninterrupted() { __asm__ __volatile__("sei" ::: "memory"); }
  };
};

struct Everything : roio::Mcp2515Traits {
  static constexpr bool all_kinds = true;
  static constexpr bool reports_outcomes = true;
};

volatile uint8_t* const spi_data = reinterpret_cast<volatile uint8_t*>(0x4E);
volatile uint8_t* const port_b = reinterpret_cast<volatile uint8_t*>(0x25);
volatile uint8_t* const pin_d = reinterpret_cast<volatile uint8_t*>(0x29);
volatile uint16_t* const timer = reinterpret_cast<volatile uint16_t*>(0x84);

bool Port::interrupt_line_is_low() {
  return (*pin_d & 4U) == 0;
}
uint32_t Port::microseconds() {
  return *timer;
}
void Port::pause(uint16_t microseconds) {
  for (const uint16_t start = *timer; static_cast<uint16_t>(*timer - start) < microseconds;) {
  }
}
uint8_t Port::Transaction::exchange(uint8_t out) {
  *spi_data = out;
  return *spi_data;
}
void Port::Transaction::send(const uint8_t* bytes, uint8_t count) {
  for (; count != 0; --count) {
    exchange(*bytes++);
  }
}
uint8_t* Port::Transaction::receive(uint8_t* bytes, uint8_t count) {
  for (; count != 0; --count) {
    *bytes++ = exchange(0);
  }
  return bytes;
}
void Port::Transaction::select(bool selected) {
  *port_b = selected ? 0 : 4;
}

template class roio::Mcp2515<Port, 0, 0>;
template class roio::Mcp2515<Port, 2, 2>;
template class roio::Mcp2515<Port, 16, 32, Everything>;
