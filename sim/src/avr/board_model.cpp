#include "avr/board_model.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

namespace roio::sim {
namespace {

constexpr std::array<McuPin, 20> uno_pins{{{'D', 0}, {'D', 1}, {'D', 2}, {'D', 3}, {'D', 4},
                                           {'D', 5}, {'D', 6}, {'D', 7}, {'B', 0}, {'B', 1},
                                           {'B', 2}, {'B', 3}, {'B', 4}, {'B', 5}, {'C', 0},
                                           {'C', 1}, {'C', 2}, {'C', 3}, {'C', 4}, {'C', 5}}};
constexpr std::array<McuPin, 31> leonardo_pins{
    {{'D', 2}, {'D', 3}, {'D', 1}, {'D', 0}, {'D', 4}, {'C', 6}, {'D', 7}, {'E', 6},
     {'B', 4}, {'B', 5}, {'B', 6}, {'B', 7}, {'D', 6}, {'C', 7}, {'B', 3}, {'B', 1},
     {'B', 2}, {'B', 0}, {'F', 7}, {'F', 6}, {'F', 5}, {'F', 4}, {'F', 1}, {'F', 0},
     {'D', 4}, {'D', 7}, {'B', 4}, {'B', 5}, {'B', 6}, {'D', 6}, {'D', 5}}};
constexpr std::array<McuPin, 70> mega_pins{
    {{'E', 0}, {'E', 1}, {'E', 4}, {'E', 5}, {'G', 5}, {'E', 3}, {'H', 3}, {'H', 4}, {'H', 5},
     {'H', 6}, {'B', 4}, {'B', 5}, {'B', 6}, {'B', 7}, {'J', 1}, {'J', 0}, {'H', 1}, {'H', 0},
     {'D', 3}, {'D', 2}, {'D', 1}, {'D', 0}, {'A', 0}, {'A', 1}, {'A', 2}, {'A', 3}, {'A', 4},
     {'A', 5}, {'A', 6}, {'A', 7}, {'C', 7}, {'C', 6}, {'C', 5}, {'C', 4}, {'C', 3}, {'C', 2},
     {'C', 1}, {'C', 0}, {'D', 7}, {'G', 2}, {'G', 1}, {'G', 0}, {'L', 7}, {'L', 6}, {'L', 5},
     {'L', 4}, {'L', 3}, {'L', 2}, {'L', 1}, {'L', 0}, {'B', 3}, {'B', 2}, {'B', 1}, {'B', 0},
     {'F', 0}, {'F', 1}, {'F', 2}, {'F', 3}, {'F', 4}, {'F', 5}, {'F', 6}, {'F', 7}, {'K', 0},
     {'K', 1}, {'K', 2}, {'K', 3}, {'K', 4}, {'K', 5}, {'K', 6}, {'K', 7}}};

constexpr std::array<std::uint8_t, 6> uno_channels{0, 1, 2, 3, 4, 5};
constexpr std::array<std::uint8_t, 12> leonardo_channels{7, 6, 5, 4, 1, 0, 8, 10, 11, 12, 13, 9};
constexpr std::array<std::uint8_t, 16> mega_channels{0, 1, 2,  3,  4,  5,  6,  7,
                                                     8, 9, 10, 11, 12, 13, 14, 15};

constexpr std::array<McuPort, 3> uno_ports{{{'B', 0x23}, {'C', 0x26}, {'D', 0x29}}};
constexpr std::array<McuPort, 5> leonardo_ports{
    {{'B', 0x23}, {'C', 0x26}, {'D', 0x29}, {'E', 0x2C}, {'F', 0x2F}}};
constexpr std::array<McuPort, 11> mega_ports{{{'A', 0x20},
                                              {'B', 0x23},
                                              {'C', 0x26},
                                              {'D', 0x29},
                                              {'E', 0x2C},
                                              {'F', 0x2F},
                                              {'G', 0x32},
                                              {'H', 0x100},
                                              {'J', 0x103},
                                              {'K', 0x106},
                                              {'L', 0x109}}};

constexpr std::array<McuUart, 1> uno_uarts{{{0, 0xC0}}};
constexpr std::array<McuUart, 1> leonardo_uarts{{{1, 0xC8}}};
constexpr std::array<McuUart, 4> mega_uarts{{{0, 0xC0}, {1, 0xC8}, {2, 0xD0}, {3, 0x130}}};

constexpr std::array<McuInterrupt, 2> uno_interrupts{{{0, {'D', 2}}, {1, {'D', 3}}}};
constexpr std::array<McuInterrupt, 5> leonardo_interrupts{
    {{0, {'D', 0}}, {1, {'D', 1}}, {2, {'D', 2}}, {3, {'D', 3}}, {6, {'E', 6}}}};
constexpr std::array<McuInterrupt, 8> mega_interrupts{{{0, {'D', 0}},
                                                       {1, {'D', 1}},
                                                       {2, {'D', 2}},
                                                       {3, {'D', 3}},
                                                       {4, {'E', 4}},
                                                       {5, {'E', 5}},
                                                       {6, {'E', 6}},
                                                       {7, {'E', 7}}}};

constexpr BoardModel uno{.kind = BoardKind::uno,
                         .name = "Uno",
                         .mcu = "atmega328p",
                         .architecture = 5,
                         .flash_bytes = 0x8000,
                         .pins = uno_pins,
                         .first_analog_pin = 14,
                         .analog_channels = uno_channels,
                         .ports = uno_ports,
                         .uarts = uno_uarts,
                         .has_usb = false,
                         .interrupts = uno_interrupts,
                         .ss = {'B', 2},
                         .mosi = {'B', 3},
                         .miso = {'B', 4},
                         .sck = {'B', 5}};
constexpr BoardModel leonardo{.kind = BoardKind::leonardo,
                              .name = "Leonardo",
                              .mcu = "atmega32u4",
                              .architecture = 5,
                              .flash_bytes = 0x8000,
                              .pins = leonardo_pins,
                              .first_analog_pin = 18,
                              .analog_channels = leonardo_channels,
                              .ports = leonardo_ports,
                              .uarts = leonardo_uarts,
                              .has_usb = true,
                              .interrupts = leonardo_interrupts,
                              .ss = {'B', 0},
                              .mosi = {'B', 2},
                              .miso = {'B', 3},
                              .sck = {'B', 1}};
constexpr BoardModel mega{.kind = BoardKind::mega,
                          .name = "Mega",
                          .mcu = "atmega2560",
                          .architecture = 6,
                          .flash_bytes = 0x4'0000,
                          .pins = mega_pins,
                          .first_analog_pin = 54,
                          .analog_channels = mega_channels,
                          .ports = mega_ports,
                          .uarts = mega_uarts,
                          .has_usb = false,
                          .interrupts = mega_interrupts,
                          .ss = {'B', 0},
                          .mosi = {'B', 2},
                          .miso = {'B', 3},
                          .sck = {'B', 1}};

}  // namespace

const BoardModel& model_of(BoardKind kind) {
  switch (kind) {
    case BoardKind::uno:
      return uno;
    case BoardKind::leonardo:
      return leonardo;
    case BoardKind::mega:
      break;
  }
  return mega;
}

McuPin mcu_pin(const BoardModel& model, int pin) {
  if (pin < 0 || static_cast<std::size_t>(pin) >= model.pins.size()) {
    throw std::invalid_argument(std::string("a ") + model.name + " has no pin " +
                                std::to_string(pin));
  }
  return model.pins[static_cast<std::size_t>(pin)];
}

std::uint8_t adc_channel(const BoardModel& model, int channel) {
  if (channel < 0 || static_cast<std::size_t>(channel) >= model.analog_channels.size()) {
    throw std::invalid_argument(std::string("a ") + model.name + " has no analog input A" +
                                std::to_string(channel));
  }
  return model.analog_channels[static_cast<std::size_t>(channel)];
}

int analog_pin(BoardKind kind, int channel) {
  const BoardModel& model = model_of(kind);
  (void)adc_channel(model, channel);
  return model.first_analog_pin + channel;
}

int main_pin(BoardKind kind, int pin) {
  const BoardModel& model = model_of(kind);
  const auto found = std::find(model.pins.begin(), model.pins.end(), mcu_pin(model, pin));
  return static_cast<int>(found - model.pins.begin());
}

std::string pin_name(BoardKind kind, int pin) {
  const BoardModel& model = model_of(kind);
  const int number = main_pin(kind, pin);
  const int channel = number - model.first_analog_pin;
  if (channel >= 0 && static_cast<std::size_t>(channel) < model.analog_channels.size()) {
    return "A" + std::to_string(channel);
  }
  if (kind == BoardKind::leonardo) {
    constexpr int first = 14;  // these have no printed number
    constexpr std::array<const char*, 4> of_spi{"MISO", "SCK", "MOSI", "RXLED"};
    constexpr int transmit_light = 30;
    if (number >= first && number < first + static_cast<int>(of_spi.size())) {
      return of_spi.at(static_cast<std::size_t>(number - first));
    }
    if (number == transmit_light) {
      return "TXLED";
    }
  }
  return std::to_string(number);
}

const char* to_string(BoardKind kind) {
  return model_of(kind).name;
}
const char* mcu_of(BoardKind kind) {
  return model_of(kind).mcu;
}

}  // namespace roio::sim
