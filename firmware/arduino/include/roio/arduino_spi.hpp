/// SPI by Arduino's own functions, for any core: no byte is under way when one of these returns.
#ifndef ROIO_ARDUINO_SPI_HPP
#define ROIO_ARDUINO_SPI_HPP

#include <Arduino.h>
#include <SPI.h>

namespace roio {

/// The first byte.
inline void spi_start(uint8_t byte) {
  SPI.transfer(byte);
}
inline void spi_put(uint8_t byte) {
  SPI.transfer(byte);
}
inline void spi_send(const uint8_t* bytes, uint8_t count) {
  while (count-- != 0) {
    SPI.transfer(*bytes++);
  }
}
inline uint8_t spi_exchange(uint8_t byte) {
  return SPI.transfer(byte);
}
inline uint8_t* spi_receive(uint8_t* bytes, uint8_t count) {
  while (count-- != 0) {
    *bytes++ = SPI.transfer(0);
  }
  return bytes;
}
inline uint8_t* spi_receive_more(uint8_t* bytes, uint8_t count) {
  return spi_receive(bytes, count);
}
inline void spi_finish() {}

}  // namespace roio

#endif
