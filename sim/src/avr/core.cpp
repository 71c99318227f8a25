#include "avr/core.hpp"

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <new>
#include <stdexcept>

namespace roio::sim {
namespace {

// Registers at the same place in all three MCUs.
constexpr std::uint16_t watchdog_control = 0x60;
constexpr unsigned watchdog_enable = 0x08;
constexpr std::uint16_t out_opcode = 0xB800;
constexpr std::uint16_t out_mask = 0xF800;
constexpr std::uint16_t sbi_opcode = 0x9A00;
constexpr std::uint16_t sbi_mask = 0xFF00;
constexpr std::uint16_t jump_to_itself = 0xCFFF;
constexpr AvrCore::Cycle response_cycles = 4;  // one more where the program counter has 22 bits
constexpr AvrCore::Cycle wake_up_cycles = 4;
constexpr std::size_t address_space = 0x1'0000;
constexpr std::uint8_t nothing_written = 0xFF;
constexpr std::uint32_t register_irqs = AVR_IOMEM_IRQ_ALL + 1;  // for each bit, and for all
constexpr std::uint32_t supply_mv = 5000;

std::string hexadecimal(std::uint64_t value) {
  std::array<char, 24> text{};
  (void)std::snprintf(text.data(), text.size(), "0x%04llX", static_cast<unsigned long long>(value));
  return text.data();
}

// simavr colours what it prints.
std::string plain(const char* text) {
  std::string result;
  for (const char* c = text; *c != '\0'; ++c) {
    if (*c == '\x1B') {
      while (*c != '\0' && *c != 'm') {
        ++c;
      }
      if (*c == '\0') {
        break;
      }
    } else if (*c != '\n') {
      result += *c;
    }
  }
  return result;
}

}  // namespace

// simavr forgets most of what it has allocated.
void AvrCore::Terminate::operator()(avr_t* avr) const {
  for (auto& slot : avr->io) {
    avr_free_irq(slot.irq, register_irqs);
  }
  avr_int_table_t& table = avr->interrupts;
  for (int i = 0; i < table.vector_count; ++i) {
    avr_free_irq(table.vector[i]->irq, AVR_INT_IRQ_COUNT);
  }
  avr_free_irq(table.irq, AVR_INT_IRQ_COUNT);
  avr_terminate(avr);
  std::free(avr->irq_pool.irq);  // NOLINT
  std::free(avr);                // NOLINT
}

AvrCore::AvrCore(const BoardModel& model, const AvrImage& image)
    : program_bytes_(image.flash.size()) {
  static std::once_flag once;
  std::call_once(once, [] { avr_global_logger_set(log); });
  avr_.reset(avr_make_mcu_by_name(model.mcu));
  if (!avr_) {
    throw std::runtime_error(std::string("this libsimavr knows no ") + model.mcu);
  }
  avr_init(avr_.get());
  avr_->custom.data = this;
  avr_->frequency = clock_hz;
  avr_->vcc = avr_->avcc = avr_->aref = supply_mv;
  avr_->log = LOG_ERROR;
  run_as_made_ = avr_->run;
  make_room();
  load(image);
}

// simavr finds that an address is beyond its memory, and then goes there nevertheless.
void AvrCore::make_room() const {
  const auto enlarge = [](std::uint8_t*& memory, std::size_t size, std::uint8_t fill) {
    if (size < address_space) {
      // NOLINTNEXTLINE: simavr's own, and freed by it
      auto* const larger = static_cast<std::uint8_t*>(std::realloc(memory, address_space));
      if (larger == nullptr) {
        throw std::bad_alloc();
      }
      std::fill(larger + size, larger + address_space, fill);
      memory = larger;
    }
  };
  enlarge(avr_->data, std::size_t{avr_->ramend} + 1, 0);
  enlarge(avr_->flash, std::size_t{avr_->flashend} + 1 + sizeof(std::uint16_t), nothing_written);
}

void AvrCore::load(const AvrImage& image) const {
  std::copy(image.flash.begin(), image.flash.end(), avr_->flash);
  avr_->codeend = static_cast<std::uint32_t>(image.flash.size());
  if (!image.eeprom.empty()) {
    std::vector<std::uint8_t> eeprom = image.eeprom;
    avr_eeprom_desc_t description{};
    description.ee = eeprom.data();
    description.size = static_cast<std::uint32_t>(
        std::min<std::size_t>(eeprom.size(), std::size_t{avr_->e2end} + 1));
    avr_ioctl(avr_.get(), AVR_IOCTL_EEPROM_SET, &description);
  }
}

// --- running -------------------------------------------------------------------------------------

void AvrCore::run_until(Cycle target) {
  limit_ = target;
  stop_ = false;
  while (!stop_ && avr_->cycle < limit_ && alive()) {
    if (avr_->run != run_as_made_) {  // the watchdog has put its own there, which resets
      avr_->run(avr_.get());
      restarted();
      continue;
    }
    avr_->run_cycle_limit = limit_ - avr_->cycle;
    const Cycle to_next_timer = avr_cycle_timer_process(avr_.get());
    // A timer that is registered within the chunk now ends it; simavr would let it run on from
    // there for as long as the limit was at its beginning.
    avr_->run_cycle_limit = 1;
    if (stop_ || avr_->cycle >= limit_ || avr_->run != run_as_made_) {
      continue;
    }
    if (avr_->state == cpu_Sleeping) {
      sleep(to_next_timer);
    } else if (avr_->interrupt_state == 0 || !enter_interrupt()) {
      run_chunk();
    }
  }
}

void AvrCore::run_chunk() {
  in_instruction_ = true;
  avr_->pc = avr_run_one(avr_.get());
  in_instruction_ = false;
  check();
}

void AvrCore::sleep(Cycle to_next_timer) {
  if (avr_->sreg[S_I] == 0) {
    if (!watchdog_resets()) {
      halted_ = true;
      trouble_ = "halted: asleep with interrupts off, at " + hexadecimal(avr_->pc);
      return;
    }
  }
  slept_ = true;
  avr_->cycle += std::clamp<Cycle>(to_next_timer, 1, limit_ - avr_->cycle);
}

// simavr takes no time for it, and lets two instructions pass after SEI and RETI in place of one.
bool AvrCore::enter_interrupt() {
  const bool enabled = avr_->sreg[S_I] != 0;
  const bool delayed = avr_->interrupt_state < 0;
  avr_service_interrupts(avr_.get());
  if (delayed && avr_->interrupt_state > 0) {
    avr_service_interrupts(avr_.get());
  }
  if (!enabled || avr_->sreg[S_I] != 0) {
    return false;
  }
  avr_->cycle += response_cycles + (avr_->address_size > 2 ? 1U : 0U);
  avr_->cycle += slept_ ? wake_up_cycles : 0U;
  slept_ = false;
  const avr_int_table_t& table = avr_->interrupts;
  if (entered_ && table.running_ptr > 0) {
    entered_(*table.running[table.running_ptr - 1]);
  }
  return true;
}

void AvrCore::check() {
  if (!alive()) {
    if (avr_->state == cpu_Crashed && trouble_.empty()) {
      crash("the program counter has left the flash");
    }
  } else if (avr_->pc >= program_bytes_) {
    crash("the program has run into empty flash");
  } else if (avr_->sreg[S_I] == 0 && opcode() == jump_to_itself && !watchdog_resets()) {
    halted_ = true;
    trouble_ = "halted: in an empty loop with interrupts off, at " + hexadecimal(avr_->pc);
  }
}

void AvrCore::crash(const std::string& what) {
  if (trouble_.empty()) {
    trouble_ = "crashed: " + what + ", at " + hexadecimal(avr_->pc);
  }
  avr_->state = cpu_Crashed;
}

void AvrCore::limit(Cycle cycle) {
  limit_ = std::min(limit_, cycle);
  // The chunk under way may be longer: it ends here, and the loop measures a new one.
  avr_->run_cycle_count = 1;
}

void AvrCore::stop() {
  stop_ = true;
  limit(limit_);
}

void AvrCore::reset() {
  avr_reset(avr_.get());
  avr_regbit_set(avr_.get(), avr_->reset_flags.extrf);
  avr_->run = run_as_made_;
  restarted();
}

void AvrCore::restarted() {
  slept_ = false;
  halted_ = false;
  trouble_.clear();
  if (restarted_) {
    restarted_();
  }
}

// --- what it is up to ----------------------------------------------------------------------------

bool AvrCore::alive() const {
  return !halted_ && trouble_.empty() &&
         (avr_->state == cpu_Running || avr_->state == cpu_Sleeping);
}

Board::State AvrCore::state() const {
  if (halted_) {
    return Board::State::halted;
  }
  if (!alive()) {
    return Board::State::crashed;
  }
  return avr_->state == cpu_Sleeping ? Board::State::sleeping : Board::State::running;
}

bool AvrCore::watchdog_resets() const {
  return (data(watchdog_control) & watchdog_enable) != 0;
}

std::uint16_t AvrCore::opcode() const {
  return static_cast<std::uint16_t>(avr_->flash[avr_->pc] | avr_->flash[avr_->pc + 1] << 8);
}

std::uint8_t AvrCore::written_ones(std::uint8_t value) const {
  const std::uint16_t code = opcode();
  return (code & sbi_mask) == sbi_opcode ? static_cast<std::uint8_t>(1U << (code & 7U)) : value;
}

// OUT takes one cycle; SBI, CBI and all that store to data memory take two.
AvrCore::Cycle AvrCore::effect_cycle() const {
  if (!in_instruction_) {
    return avr_->cycle;
  }
  return avr_->cycle + ((opcode() & out_mask) == out_opcode ? 1U : 2U);
}

// --- interrupts ----------------------------------------------------------------------------------

avr_int_vector_t& AvrCore::vector(std::uint16_t enable_register, unsigned enable_bit) const {
  avr_int_vector_t* const found = find_vector([&](const avr_int_vector_t& vector) {
    return vector.enable.reg == enable_register && vector.enable.bit == enable_bit;
  });
  if (found == nullptr) {
    throw std::logic_error("this libsimavr lacks an interrupt that is enabled at " +
                           hexadecimal(enable_register));
  }
  return *found;
}

avr_int_vector_t& AvrCore::vector(unsigned number) const {
  avr_int_vector_t* const found =
      find_vector([&](const avr_int_vector_t& vector) { return vector.vector == number; });
  if (found == nullptr) {
    throw std::logic_error("this libsimavr lacks interrupt " + std::to_string(number));
  }
  return *found;
}

// simavr queues a vector anew each time, also when the one that was cleared is still in its queue;
// firmware that polls with interrupts off would fill it.
void AvrCore::raise(avr_int_vector_t& vector) const {
  const avr_int_pending_t& queue = avr_->interrupts.pending;
  bool queued = false;
  for (unsigned i = queue.read; i != queue.write; i = (i + 1) % avr_int_pending_fifo_size) {
    queued = queued || queue.buffer[i] == &vector;
  }
  if (!queued || vector.pending != 0 || avr_regbit_get(avr_.get(), vector.enable) == 0) {
    avr_raise_interrupt(avr_.get(), &vector);
    return;
  }
  avr_regbit_set(avr_.get(), vector.raised);
  vector.pending = 1;
  if (avr_->sreg[S_I] != 0 && avr_->interrupt_state == 0) {
    avr_->interrupt_state = 1;
  }
  if (avr_->state == cpu_Sleeping) {
    avr_->state = cpu_Running;
  }
}

void AvrCore::clear(avr_int_vector_t& vector) const {
  vector.pending = 0;
  avr_regbit_clear(avr_.get(), vector.raised);
}

// --- simavr's log --------------------------------------------------------------------------------

void AvrCore::log(avr_t* avr, int level, const char* format, va_list arguments) {
  if (avr == nullptr || avr->custom.data == nullptr || level != LOG_ERROR) {
    return;
  }
  std::array<char, 256> text{};
  (void)std::vsnprintf(text.data(), text.size(), format, arguments);
  static_cast<AvrCore*>(avr->custom.data)->crash(plain(text.data()));
}

}  // namespace roio::sim
