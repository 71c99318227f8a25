/// UsbLine: the serial line of a board whose processor has USB itself (Leonardo, Micro). USB
/// carries its own check and has flow control; so nothing overflows here, and the rate means
/// nothing.
#ifndef ROIO_BRIDGE_LINE_USB_H
#define ROIO_BRIDGE_LINE_USB_H

#include <Arduino.h>

#include "ring.h"

namespace roio {
namespace bridge {

class UsbLine {
 public:
  static constexpr bool rate_matters = false;
  /// While frames come one after the other.
  static constexpr uint8_t pump_below = 128;

  UsbLine() : in_at_(0), in_end_(0), in_bytes_(), out_(), out_bytes_(), held_(false) {}

  void begin(uint32_t rate_bps) { Serial.begin(rate_bps); }
  void set_rate(uint32_t) {}

  /// What has come, as far as it lies in one piece; consume() what was used of it.
  /// @return how many bytes; 0: none.
  uint8_t peek(const uint8_t*& bytes) {
    if (in_at_ == in_end_) {
      // All at once: Serial.read() takes 100 cycles for each byte.
      const int count = USB_Recv(CDC_RX, in_bytes_, sizeof in_bytes_);
      in_at_ = 0;
      in_end_ = count > 0 ? static_cast<uint8_t>(count) : uint8_t{0};
    }
    bytes = in_bytes_ + in_at_;
    return static_cast<uint8_t>(in_end_ - in_at_);
  }
  void consume(uint8_t count) { in_at_ = static_cast<uint8_t>(in_at_ + count); }

  uint8_t room() const { return out_.room(); }
  /// Where records are written, from the first byte that is not committed yet.
  struct Sink {
    uint8_t* bytes;
    uint8_t begin;
    void put(uint8_t offset, uint8_t byte) { bytes[static_cast<uint8_t>(begin + offset)] = byte; }
  };
  Sink sink() { return Sink{out_bytes_, out_.head}; }
  void commit(uint8_t count) { out_.head = static_cast<uint8_t>(out_.head + count); }

  void hold() { held_ = true; }
  void release() { held_ = false; }
  bool is_drained() const { return out_.size() == 0; }
  static uint32_t overruns() { return 0; }

  /// Gives USB what it has room for, and sends it: the host comes for it many times a millisecond.
  ///
  /// One byte of a packet stays free: behind a full one, Arduino would send an empty one, and wait
  /// up to 250 ms for the PC to take it.
  void pump() {
    if (held_ || out_.size() == 0) {
      return;
    }
    const int room = Serial.availableForWrite() - 1;
    if (room <= 0) {
      return;
    }
    uint8_t count = out_.size();
    const uint16_t to_the_end = static_cast<uint16_t>(sizeof out_bytes_ - out_.tail);
    if (count > to_the_end) {
      count = static_cast<uint8_t>(to_the_end);
    }
    if (count > room) {
      count = static_cast<uint8_t>(room);
    }
    out_.tail = static_cast<uint8_t>(out_.tail + Serial.write(out_bytes_ + out_.tail, count));
    const uint8_t before = SREG;
    cli();  // its interrupts select endpoints, too
    Serial.flush();
    SREG = before;
  }

 private:
  uint8_t in_at_;
  uint8_t in_end_;
  uint8_t in_bytes_[24];  // some 20 us
  RingEnds out_;
  uint8_t out_bytes_[ring_size];
  bool held_;
};

}  // namespace bridge
}  // namespace roio

#endif
