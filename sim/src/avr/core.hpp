/// AvrCore: simavr's AVR, run by a loop of ours: to a given cycle and not a chunk further, without
/// sleeping on the host, with the cycles that an interrupt's response takes, and with everything
/// that a real AVR would not survive turned into an error.
#ifndef ROIO_SIM_AVR_CORE_HPP
#define ROIO_SIM_AVR_CORE_HPP

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "avr/board_model.hpp"
#include "avr/image.hpp"
#include "avr/simavr.hpp"

namespace roio::sim {

class AvrCore {
 public:
  static constexpr std::uint32_t clock_hz = 16'000'000;
  using Cycle = std::uint64_t;

  AvrCore(const BoardModel& model, const AvrImage& image);
  ~AvrCore() = default;
  AvrCore(const AvrCore&) = delete;
  AvrCore& operator=(const AvrCore&) = delete;

  /// Runs to that cycle, or to the limit or stop() that comes up on the way; one instruction
  /// further at most. Returns at once when it is dead.
  void run_until(Cycle target);
  /// No further than this, in the run under way.
  void limit(Cycle cycle);
  /// Ends the run with the instruction under way.
  void stop();
  /// It was dead meanwhile.
  void skip_to(Cycle cycle) const { avr_->cycle = cycle; }
  /// The reset button.
  void reset();

  [[nodiscard]] Cycle cycle() const { return avr_->cycle; }
  /// When the instruction under way takes effect outside: its end. Else now.
  [[nodiscard]] Cycle effect_cycle() const;
  [[nodiscard]] Board::State state() const;
  [[nodiscard]] const std::string& trouble() const { return trouble_; }
  void crash(const std::string& what);
  /// Called after each restart but the first, registers at their reset values.
  void on_restart(std::function<void()> listener) { restarted_ = std::move(listener); }

  // --- for peripherals ---------------------------------------------------------------------------

  [[nodiscard]] avr_t* avr() const { return avr_.get(); }
  [[nodiscard]] std::uint8_t& data(std::uint16_t address) const { return avr_->data[address]; }
  /// The interrupt that this bit enables. It must exist.
  [[nodiscard]] avr_int_vector_t& vector(std::uint16_t enable_register, unsigned enable_bit) const;
  /// The interrupt with this number in the MCU's table. It must exist.
  [[nodiscard]] avr_int_vector_t& vector(unsigned number) const;
  /// Sets the vector's flag, and asks for the interrupt if it is enabled.
  void raise(avr_int_vector_t& vector) const;
  /// Clears both.
  void clear(avr_int_vector_t& vector) const;
  /// Called when an interrupt has been entered.
  void on_interrupt(std::function<void(const avr_int_vector_t&)> listener) {
    entered_ = std::move(listener);
  }
  /// What the instruction under way writes to a register where ones act: SBI writes a single one,
  /// but simavr writes back what it has read besides.
  [[nodiscard]] std::uint8_t written_ones(std::uint8_t value) const;

  /// Takes over what the program writes to a register; in place of simavr's.
  template <auto Write, class T>
  void take_writes(std::uint16_t address, T& object) const {
    auto& slot = avr_->io[AVR_DATA_TO_IO(address)].w;
    slot.param = &object;
    slot.c = [](avr_t* /*avr*/, avr_io_addr_t at, std::uint8_t value, void* parameter) {
      (static_cast<T*>(parameter)->*Write)(at, value);
    };
  }
  /// The same for reading.
  template <auto Read, class T>
  void take_reads(std::uint16_t address, T& object) const {
    auto& slot = avr_->io[AVR_DATA_TO_IO(address)].r;
    slot.param = &object;
    slot.c = [](avr_t* /*avr*/, avr_io_addr_t at, void* parameter) {
      return (static_cast<T*>(parameter)->*Read)(at);
    };
  }
  /// Calls a member at a cycle; it returns the next one, or 0.
  template <auto Call, class T>
  void at(Cycle cycle, T& object) const {
    const Cycle span = cycle > avr_->cycle ? cycle - avr_->cycle : 1;
    avr_cycle_timer_register(avr_.get(), span, timer<Call, T>(), &object);
  }
  template <auto Call, class T>
  void cancel(T& object) const {
    avr_cycle_timer_cancel(avr_.get(), timer<Call, T>(), &object);
  }

 private:
  struct Terminate {
    void operator()(avr_t* avr) const;
  };
  template <auto Call, class T>
  static avr_cycle_timer_t timer() {
    return [](avr_t* /*avr*/, avr_cycle_count_t when, void* parameter) -> avr_cycle_count_t {
      return (static_cast<T*>(parameter)->*Call)(when);
    };
  }
  [[nodiscard]] std::uint16_t opcode() const;
  /// @return none: nullptr.
  template <typename IsIt>
  [[nodiscard]] avr_int_vector_t* find_vector(const IsIt& is_it) const {
    const avr_int_table_t& table = avr_->interrupts;
    const auto* const end = table.vector + table.vector_count;
    const auto* const found = std::find_if(
        table.vector, end, [&](const avr_int_vector_t* vector) { return is_it(*vector); });
    return found != end ? *found : nullptr;
  }
  static void log(avr_t* avr, int level, const char* format, va_list arguments);

  void make_room() const;
  void load(const AvrImage& image) const;
  [[nodiscard]] bool alive() const;
  void sleep(Cycle to_next_timer);
  bool enter_interrupt();
  void run_chunk();
  void check();
  [[nodiscard]] bool watchdog_resets() const;
  void restarted();

  std::unique_ptr<avr_t, Terminate> avr_;
  avr_run_t run_as_made_ = nullptr;
  Cycle program_bytes_;
  Cycle limit_ = 0;
  bool stop_ = false;
  bool in_instruction_ = false;
  bool slept_ = false;
  bool halted_ = false;
  std::string trouble_;
  std::function<void()> restarted_;
  std::function<void(const avr_int_vector_t&)> entered_;
};

}  // namespace roio::sim

#endif
