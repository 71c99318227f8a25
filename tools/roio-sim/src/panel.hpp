/// Panel: one simulated board with what a person has of it: what it shows, and what can be done to
/// it.
#ifndef ROIO_SIM_TOOL_PANEL_HPP
#define ROIO_SIM_TOOL_PANEL_HPP

#include <map>
#include <memory>
#include <optional>
#include <roio/sim/board.hpp>
#include <roio/sim/serial_pty.hpp>
#include <string>

#include "options.hpp"
#include "report.hpp"

namespace roio::sim_tool {

class Panel {
 public:
  /// @throws std::runtime_error, std::invalid_argument: as sim::Board and sim::SerialPty do.
  Panel(sim::CanBus& bus, const BoardWish& wish, std::uint32_t bitrate_bps, Report& report);
  Panel(const Panel&) = delete;
  Panel& operator=(const Panel&) = delete;
  ~Panel() = default;

  [[nodiscard]] const std::string& name() const { return board_.name(); }

  /// Whether the board has the pins, inputs and UARTs that an action names, and they are free.
  /// @throws std::invalid_argument
  void check(const Action& action) const;
  /// @throws std::invalid_argument: as check() does.
  void apply(const Action& action);

  /// Reports what has lasted long enough; to be called about once in a millisecond.
  void look();
  /// The last look: also what is unfinished, and what was wrong.
  void finish();

 private:
  struct Pin {
    bool high = false;   // as it is
    bool shown = false;  // as it was reported
    sim::SimTime changed{0};
    std::optional<sim::SimTime> rise;
    bool is_regular = false;  // the last two rises were as far apart as a servo's are
    int pulses = 0;           // one after the other that a servo understands
    std::optional<int> degrees;
    std::optional<int> degrees_shown;
    sim::SimTime degrees_time{0};
  };
  struct Line {
    std::string text;
    sim::SimTime last{0};
  };
  struct CanState {
    std::string name;
    std::uint32_t bitrate_bps = 0;
    bool operator==(const CanState&) const = default;
  };

  // What a command has put to a pin, until it is taken away.
  struct Outside {
    std::string what;
    bool is_told = false;  // that it has no effect
  };

  void do_action(const Press& press);
  void do_action(const SetPin& set);
  void do_action(const SetAnalog& set);
  void do_action(const Serial& serial);
  void do_action(const Reset& reset);
  void do_action(const Plug& plug);
  template <typename Other>
  void do_action(const Other&) {}

  void watch_pins(const BoardWish& wish);
  void watch_serial(const BoardWish& wish);
  void pin_changed(int number, sim::SimTime time, bool high);
  static void pulse_ended(Pin& pin, sim::SimTime width);
  void look_at_pin(int number, Pin& pin);
  void look_outside();
  void serial_byte(int uart, std::uint8_t byte);
  void end_line(int uart, Line& line);
  void look_at_chip();
  void count_overflows();
  void show_terminal();
  void plug_terminal(bool in);
  void tell_lost_bytes();
  void tell_unused_chip();
  void tell_violations();
  [[nodiscard]] CanState can_state();
  [[nodiscard]] std::string pin_name(int number) const;
  [[nodiscard]] int number_of(const PinName& pin) const;
  [[nodiscard]] int number_to_drive(const PinName& pin) const;

  sim::CanBus& bus_;
  std::uint32_t bitrate_bps_;
  Report& report_;
  sim::Board board_;
  int select_pin_;
  std::optional<int> interrupt_pin_;
  std::map<int, Pin> pins_;
  std::map<int, Outside> outside_;
  std::map<int, Line> lines_;
  CanState state_;        // as it is
  CanState state_shown_;  // as it was reported
  sim::SimTime state_since_{0};
  std::uint32_t other_bitrate_bps_ = 0;  // than the bus has, as it was told last
  bool was_in_loopback_ = false;
  std::uint64_t overflows_seen_ = 0;
  std::uint64_t overflows_ = 0;
  std::unique_ptr<sim::SerialPty> terminal_;
  std::string terminal_link_;
};

}  // namespace roio::sim_tool

#endif
