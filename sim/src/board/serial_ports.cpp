#include "board/serial_ports.hpp"

#include <stdexcept>
#include <string>
#include <utility>

namespace roio::sim {

void SerialPorts::add(int number, std::unique_ptr<AvrSerial> line) {
  line->on_send([this, number](AvrCore::Cycle end, std::uint8_t byte) { sent(number, end, byte); });
  ports_.push_back({number, std::move(line), nullptr, std::nullopt});
}

void SerialPorts::sent(int number, AvrCore::Cycle end, std::uint8_t byte) {
  if (!port(number).listener) {
    return;
  }
  post_(end, [this, number, byte, bitrate_bps = line(number).bitrate_bps(), era = era_] {
    const Listener listener = port(number).listener;
    if (listener && era == era_) {
      port(number).sent_bps = bitrate_bps;
      listener(byte);
    }
  });
}

void SerialPorts::reset() {
  ++era_;
  for (const Port& port : ports_) {
    port.line->reset();
  }
}

void SerialPorts::interrupt_entered(const avr_int_vector_t& vector) {
  for (const Port& port : ports_) {
    port.line->interrupt_entered(vector);
  }
}

SerialPorts::Port& SerialPorts::port(int number) {
  for (Port& port : ports_) {
    if (port.number == number) {
      return port;
    }
  }
  throw std::invalid_argument(std::string("a ") + model_.name + " has no serial port " +
                              std::to_string(number));
}

}  // namespace roio::sim
