#include <roio/sim/spi_wire.hpp>
#include <utility>

namespace roio::sim {

void SpiWire::select() {
  step();
  selected_ = true;
  first_byte_ = true;
  bus_.run_for(timing_.select);
  if (fault_ == Fault::none) {
    chip_.select();
  }
}

void SpiWire::deselect() {
  step();
  selected_ = false;
  bus_.run_for(timing_.select);
  chip_.deselect();
}

void SpiWire::set_fault(Fault fault) {
  const bool was_connected = fault_ == Fault::none;
  fault_ = fault;
  if (fault != Fault::none) {
    chip_.deselect();
  } else if (selected_ && !was_connected) {
    chip_.select();  // plugged in while the line is low: what follows looks like an instruction
  }
}

bool SpiWire::interrupt_line_is_low() {
  return std::exchange(spike_, false) || line_held_low_ ||
         (fault_ == Fault::none && !line_cut_ && !chip_.interrupt_pin());
}

void SpiWire::clear_faults() {
  set_fault(Fault::none);
  set_bit_flips(0, 0);
  lose_select_in_ = 0;
  spike_ = false;
  line_held_low_ = false;
  line_cut_ = false;
}

void SpiWire::set_bit_flips(double probability, std::uint32_t seed) {
  flip_ = std::bernoulli_distribution(probability);
  generator_.seed(seed);
}

std::uint8_t SpiWire::with_flips(std::uint8_t byte) {
  if (flip_.p() > 0) {
    for (unsigned bit = 0; bit < 8; ++bit) {
      byte = static_cast<std::uint8_t>(byte ^ ((flip_(generator_) ? 1U : 0U) << bit));
    }
  }
  return byte;
}

std::uint8_t SpiWire::exchange(std::uint8_t out) {
  step();
  ++bytes_;
  transactions_ += first_byte_ ? 1 : 0;
  first_byte_ = false;
  bus_.run_for(timing_.byte);
  if (lose_select_in_ > 0 && --lose_select_in_ == 0 && fault_ == Fault::none) {
    chip_.deselect();
    chip_.select();
  }
  if (fault_ != Fault::none) {
    return fault_ == Fault::stuck_low ? 0x00 : 0xFF;
  }
  return with_flips(chip_.exchange(with_flips(out)));
}

}  // namespace roio::sim
