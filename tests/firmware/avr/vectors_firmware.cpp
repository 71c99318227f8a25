// Runs the worked examples on an atmega328p and reports over the serial port:
//
//   line 260: crc            for each disagreement, with its line in docs/protocol.md
//   30 of 30 vectors agree
//   fit: 312 bytes of stack
//
// Then it sleeps with interrupts off, which ends the simulation.
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/pgmspace.h>
#include <avr/sleep.h>
#include <stdlib.h>
#include <string.h>

#include <roio/filter_mcp2515.hpp>
#include <roio/filter_socketcan.hpp>
#include <roio/frame_length.hpp>
#include <roio/message.hpp>
#include <roio/version.hpp>

namespace {

struct Vector {
  int line;
  roio::Message message;
  uint32_t id;
  uint8_t bits;
  uint16_t crc;
  uint8_t registers[4];
};

#include "vectors.inc"

constexpr uint8_t vector_count = sizeof vectors / sizeof vectors[0];

void put(char c) {
  while (!(UCSR0A & (1 << UDRE0))) {
  }
  UDR0 = static_cast<uint8_t>(c);
}

void print(const char* text) {
  while (*text != '\0') {
    put(*text++);
  }
}

void print(int number) {
  char digits[8];
  print(itoa(number, digits, 10));
}

void report(const Vector& vector, const char* what) {
  print("line ");
  print(vector.line);
  print(": ");
  print(what);
  put('\n');
}

bool same(const roio::Message& a, const roio::Message& b) {
  return a.header == b.header && a.length == b.length && memcmp(a.data, b.data, sizeof a.data) == 0;
}

/// What the row and the library disagree about; null when they do not.
const char* disagreement(const Vector& vector) {
  roio::Frame frame;
  if (roio::to_frame(vector.message, frame) != roio::Status::ok) {
    return "to_frame";
  }
  if (frame.id != vector.id || frame.length != vector.message.length) {
    return "id";
  }
  roio::Message message;
  if (roio::to_message(frame, message) != roio::Status::ok || !same(message, vector.message)) {
    return "to_message";
  }
  if (roio::wire_bits(frame) != vector.bits) {
    return "bits";
  }
  if (roio::wire_crc(frame) != vector.crc) {
    return "crc";
  }
  uint8_t registers[4];
  roio::to_mcp2515_registers(vector.id, registers);
  registers[1] |= roio::Mcp2515Filters::exide;
  if (memcmp(registers, vector.registers, sizeof registers) != 0 ||
      roio::from_mcp2515_registers(registers) != vector.id) {
    return "registers";
  }
  return nullptr;
}

void check_vectors() {
  uint8_t agreed = 0;
  for (uint8_t i = 0; i < vector_count; ++i) {
    Vector vector;
    memcpy_P(&vector, &vectors[i], sizeof vector);
    if (const char* const what = disagreement(vector)) {
      report(vector, what);
    } else {
      ++agreed;
    }
  }
  print(agreed);
  print(" of ");
  print(vector_count);
  print(" vectors agree\n");
}

constexpr uint8_t paint = 0xC5;

/// Fills the free RAM below the stack, and tells afterwards how much of it was overwritten.
uint8_t* stack_end() {
  return reinterpret_cast<uint8_t*>(SP);
}
extern "C" uint8_t __heap_start;

__attribute__((noinline)) void paint_stack() {
  for (uint8_t* p = &__heap_start; p < stack_end() - 8; ++p) {
    *p = paint;
  }
}

__attribute__((noinline)) int unpainted_stack() {
  const uint8_t* p = &__heap_start;
  while (*p == paint) {
    ++p;
  }
  return static_cast<int>(stack_end() - p);
}

template <uint8_t Capacity>
__attribute__((noinline)) roio::Mcp2515Filters fit(const roio::FilterProgram<Capacity>& program) {
  return roio::fit_mcp2515(program);
}

/// Fits a program and tells how much stack that takes.
template <uint8_t Capacity>
roio::Mcp2515Filters measured_fit(const roio::FilterProgram<Capacity>& program) {
  paint_stack();
  const roio::Mcp2515Filters image = fit(program);
  const int used = unpainted_stack();
  print("fit of ");
  print(program.size());
  print(" rules: ");
  print(used);
  print(image.exact ? " bytes of stack, exact\n" : " bytes of stack, not exact\n");
  return image;
}

/// The plain node 0.2 of docs/protocol.md "Filters".
void check_plain_node() {
  static const uint8_t expected[8][4] = {{0x1F, 0xE3, 0xE0, 0x00}, {0x1F, 0xE3, 0xE0, 0x00},
                                         {0x00, 0x08, 0x40, 0x00}, {0x00, 0xEB, 0xE0, 0x00},
                                         {0x00, 0x08, 0x40, 0x00}, {0x00, 0x08, 0x40, 0x00},
                                         {0x00, 0x08, 0x40, 0x00}, {0x00, 0x08, 0x40, 0x00}};
  roio::FilterProgram<2> program;
  const roio::Status status = roio::compile(roio::interest_of({0, 2}), program);
  const roio::Mcp2515Filters image = measured_fit(program);
  const bool agrees = status == roio::Status::ok &&
                      memcmp(image.mask, expected, sizeof image.mask) == 0 &&
                      memcmp(image.filter, expected + 2, sizeof image.filter) == 0;
  print(agrees ? "plain node agrees\n" : "plain node differs\n");
}

/// As many rules as the search takes on, none merging, more than fit.
void check_large_program() {
  roio::FilterProgram<8> program;
  for (uint8_t i = 0; i < 8; ++i) {
    const uint32_t id = (i ^ (i << 1)) * UINT32_C(0x01002011);
    const uint32_t mask = roio::id_mask & ~(UINT32_C(0x400) << i);
    if (program.add({id & mask, mask, roio::FilterMeaning::custom}) != roio::Status::ok) {
      print("add failed\n");
    }
  }
  measured_fit(program);
}

}  // namespace

int main() {
  UBRR0 = 0;  // as fast as it goes: nobody but the simulator listens
  UCSR0B = 1 << TXEN0;
  print("roio " ROIO_VERSION "\n");
  check_vectors();
  check_plain_node();
  check_large_program();
  print("end\n");
  while (!(UCSR0A & (1 << UDRE0))) {
  }
  cli();
  sleep_enable();
  sleep_cpu();
  return 0;
}
