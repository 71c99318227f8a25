#include "board/chip_wiring.hpp"

#include <algorithm>
#include <utility>

namespace roio::sim {
namespace {

constexpr std::uint8_t nothing_there = 0xFF;

}  // namespace

ChipWiring::ChipWiring(AvrCore& core, AvrPorts& ports, AvrSpi& spi, const BoardModel& model,
                       Board board)
    : core_(core), ports_(ports), spi_(spi), model_(model), board_(std::move(board)) {
  spi.on_violation([this](const char* what) { board_.violation(what); });
  spi.set_slave_select([this] {
    return !ports_.level(model_.ss) && ports_.outside(model_.ss) == std::optional(false);
  });
}

void ChipWiring::plug_in(CanBus& bus, const Mcp2515Options& options) {
  chip_.emplace(bus, options);
  chip_->on_interrupt_pin([this](bool high) {
    if (fault_ == SpiWire::Fault::none) {
      board_.drive_interrupt(high);
    }
  });
  board_.drive_interrupt(chip_->interrupt_pin());
}

void ChipWiring::select_pin_changed(Cycle cycle, bool selected) {
  edge_ = Edge{cycle, selected};
  core_.stop();
}

std::optional<ChipWiring::Cycle> ChipWiring::next_contact() const {
  const std::optional<Cycle> end = spi_.end();
  if (end && *end <= core_.cycle()) {
    return edge_ ? std::min(*end, edge_->cycle) : *end;
  }
  return edge_ ? std::optional(edge_->cycle) : std::nullopt;
}

void ChipWiring::make_contact() {
  const std::optional<Cycle> end = spi_.end();
  if (end && (!edge_ || *end <= edge_->cycle) && *end <= core_.cycle()) {
    finish_byte();
  } else {
    selected_ = std::exchange(edge_, std::nullopt)->selected;
    select(selected_);
  }
}

void ChipWiring::select(bool selected) {
  const bool reaches = selected && fault_ == SpiWire::Fault::none;
  if (chip_ && reaches != std::exchange(chip_selected_, reaches)) {
    if (reaches) {
      chip_->select();
    } else {
      chip_->deselect();
    }
  }
}

void ChipWiring::finish_byte() {
  const std::uint8_t out = spi_.out();
  std::uint8_t in = fault_ == SpiWire::Fault::stuck_low ? 0x00 : nothing_there;
  if (chip_selected_) {
    in = exchange(out);
  }
  spi_.finish(in);
  board_.exchanged(out, in);
}

std::uint8_t ChipWiring::exchange(std::uint8_t out) {
  if (!ports_.level(model_.sck)) {
    board_.violation("SCK is not an output");
    return nothing_there;
  }
  if (spi_.mode() != 0 && spi_.mode() != 3) {
    board_.violation("the chip knows SPI modes 0 and 3 only");
    return nothing_there;
  }
  const bool data = ports_.level(model_.mosi).has_value();
  if (!data) {
    board_.violation("MOSI is not an output");
  }
  return chip_->exchange(data ? out : nothing_there);
}

void ChipWiring::set_fault(SpiWire::Fault fault) {
  fault_ = fault;
  select(selected_);
  if (!chip_) {
    return;
  }
  if (fault == SpiWire::Fault::none) {
    board_.drive_interrupt(chip_->interrupt_pin());
  } else {
    board_.drive_interrupt(std::nullopt);
  }
}

}  // namespace roio::sim
