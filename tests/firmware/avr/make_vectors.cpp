// Turns the worked examples of docs/protocol.md into a header for the AVR test.
//
//   make_vectors OUTPUT [WRONG_ROW]
//
// WRONG_ROW (from 0): gives that row a wrong CRC, for the test that sees the AVR test fail.
#include <fstream>
#include <iostream>
#include <string>

#include "vectors.hpp"

namespace {

void write_row(std::ostream& out, const roio::test::Vector& vector, unsigned crc) {
  const roio::Message& message = vector.message;
  const roio::Header& header = message.header;
  out << "    {" << vector.line << ", {{static_cast<roio::Priority>("
      << static_cast<int>(header.priority) << "), static_cast<roio::MessageClass>("
      << static_cast<int>(header.message_class) << "), {" << int{header.destination.subnet} << ", "
      << int{header.destination.node} << "}, {" << int{header.source.subnet} << ", "
      << int{header.source.node} << "}}, " << int{message.length} << ", {";
  for (const std::uint8_t byte : message.data) {
    out << int{byte} << ", ";
  }
  out << "}}, " << vector.id << "UL, " << int{vector.bits} << ", " << crc << ", {";
  for (const std::uint8_t byte : vector.registers) {
    out << int{byte} << ", ";
  }
  out << "}},  // " << vector.name << '\n';
}

void write(std::ostream& out, long wrong_row) {
  out << "const Vector vectors[] PROGMEM = {\n";
  long row = 0;
  for (const roio::test::Vector& vector : roio::test::read_vectors(ROIO_PROTOCOL_DOCUMENT)) {
    write_row(out, vector, row++ == wrong_row ? vector.crc ^ 1U : vector.crc);
  }
  out << "};\n";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::cerr << "usage: make_vectors OUTPUT [WRONG_ROW]\n";
    return 2;
  }
  try {
    std::ofstream out(argv[1]);
    write(out, argc > 2 ? std::stol(argv[2]) : -1);
    out.close();
    return out ? 0 : 1;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
