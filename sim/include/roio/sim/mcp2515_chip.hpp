/// Mcp2515Chip: Microchip's MCP2515 as its registers, its SPI and its pins show it. Written from
/// the datasheet alone and sharing no constant with the driver, so that one proves the other. What
/// is modelled and what is not: docs/internals/simulator.md. Source: MCP2515 datasheet DS20001801,
/// named by section.
#ifndef ROIO_SIM_MCP2515_CHIP_HPP
#define ROIO_SIM_MCP2515_CHIP_HPP

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <roio/sim/can_bus.hpp>
#include <string>
#include <vector>

namespace roio::sim {

struct Mcp2515Options {
  std::uint32_t osc_hz = 16'000'000;
  /// How long the crystal takes to swing, before the 128 clocks of the start-up timer count.
  SimTime crystal_start{0};
  /// The overflow flag for a frame that found both buffers full: the datasheet's flow chart says
  /// RX1OVR, reports of real chips RX0OVR.
  bool full_sets_rx0ovr = false;
  /// Whether filters, masks and RXM hold in listen-only mode, as datasheets before revision J have
  /// it; since then everything is received (10.3).
  bool listen_only_filters = false;
  /// What the registers that have no reset value hold at power-on is drawn from this.
  std::uint32_t power_on_seed = 1;
};

/// What software did that the chip does not allow: ignored by the chip, or undefined in the
/// datasheet.
struct Mcp2515Violation {
  SimTime time;
  std::string what;
  std::uint64_t times = 1;  ///< For one that is noted once, whenever it comes again.
};

/// What befell the chip since it was made; no register can tell these.
struct Mcp2515Events {
  std::uint64_t accepted = 0;    ///< Frames moved into a receive buffer.
  std::uint64_t overflowed = 0;  ///< Frames that passed the filters and found no buffer.
  std::uint64_t filtered = 0;    ///< Frames that no filter took.
  std::uint64_t sent = 0;
  std::uint64_t aborted = 0;  ///< Transmissions taken back, or given up in one-shot mode.
  std::uint64_t resets = 0;   ///< Power-on, reset pin and reset instruction.
  std::uint64_t bus_offs = 0;
};

class Mcp2515Chip : private ControllerClient {
 public:
  enum class OperationMode : std::uint8_t {
    normal = 0,
    sleep = 1,
    loopback = 2,
    listen_only = 3,
    configuration = 4,
  };

  /// Powered on right now.
  explicit Mcp2515Chip(CanBus& bus, const Mcp2515Options& options = {});
  ~Mcp2515Chip() override;
  Mcp2515Chip(const Mcp2515Chip&) = delete;
  Mcp2515Chip& operator=(const Mcp2515Chip&) = delete;

  // --- SPI (12): what the chip shifts out while it shifts a byte in ------------------------------

  void select();
  std::uint8_t exchange(std::uint8_t in);
  void deselect();

  // --- pins: true is high ------------------------------------------------------------------------

  [[nodiscard]] bool interrupt_pin() const;
  /// RXnBF; none while the pin is not enabled and floats.
  [[nodiscard]] std::optional<bool> receive_buffer_pin(int buffer) const;
  /// TXnRTS; high at first.
  void set_request_to_send_pin(int buffer, bool level);
  void reset_pin();
  /// Off and on again.
  void power_cycle();
  /// Called whenever the interrupt pin changes.
  void on_interrupt_pin(std::function<void(bool)> listener) { pin_listener_ = std::move(listener); }

  // --- for tests ---------------------------------------------------------------------------------

  /// A frame as if it had just come in from the bus: through the filters, into a buffer.
  void receive(const Frame& frame) { on_received(frame); }
  /// A register's content, read without SPI and without its side effects.
  [[nodiscard]] std::uint8_t peek(std::uint8_t address) const;
  [[nodiscard]] OperationMode mode() const { return mode_; }
  /// The rate that CNF1..3 make of the oscillator, in bit/s; 0 when the datasheet rules it out.
  [[nodiscard]] std::uint32_t bitrate_bps() const;
  [[nodiscard]] const Mcp2515Events& events() const { return events_; }
  [[nodiscard]] const std::vector<Mcp2515Violation>& violations() const { return violations_; }
  /// How many there were; violations() has the first `most_violations`.
  [[nodiscard]] std::uint64_t violation_count() const { return violation_count_; }
  static constexpr std::size_t most_violations = 10'000;
  [[nodiscard]] Controller& controller() { return controller_; }
  /// Called with every frame that was moved into a receive buffer.
  void on_accepted(std::function<void(const Frame&)> listener) {
    accepted_listener_ = std::move(listener);
  }
  /// Called with every frame that was sent.
  void on_sent(std::function<void(const Frame&)> listener) { sent_listener_ = std::move(listener); }

 private:
  // What the bytes of one SPI instruction have come to.
  struct Instruction {
    std::uint8_t code = 0;
    std::uint8_t bytes = 0;     // how many have come in, the instruction itself included
    std::uint8_t address = 0;   // the next register
    std::uint8_t mask = 0;      // of BIT MODIFY
    std::uint8_t frees = 0;     // CANINTF bit that READ RX BUFFER clears at the end
    std::uint8_t requests = 0;  // buffers that RTS asks for at the end
  };

  // registers
  [[nodiscard]] std::uint8_t read_register(std::uint8_t address) const;
  void write_register(std::uint8_t address, std::uint8_t value, std::uint8_t mask = 0xFF);
  void register_written(std::uint8_t address, std::uint8_t before);
  void modify_register(std::uint8_t address, std::uint8_t value, std::uint8_t mask);
  void control_written();
  void transmit_control_written(int buffer, std::uint8_t before);
  void receive_control_written(std::uint8_t address);
  [[nodiscard]] std::uint8_t status_register() const;
  [[nodiscard]] std::uint8_t buffer_pin_register() const;
  [[nodiscard]] std::uint8_t request_pin_register() const;
  [[nodiscard]] std::uint8_t interrupt_code() const;
  [[nodiscard]] bool is_readable_now(std::uint8_t address) const;
  void set_flag(std::uint8_t flag);
  void update_pins();
  void violation(std::string what);

  // SPI
  std::uint8_t begin_instruction(std::uint8_t code);
  std::uint8_t continue_instruction(std::uint8_t in);
  [[nodiscard]] std::uint8_t read_status() const;
  [[nodiscard]] std::uint8_t receive_status() const;

  // power, modes, bit timing
  void start(bool power_on);
  void reset_registers(bool power_on);
  void start_oscillator(SimTime crystal_start);
  void oscillator_runs();
  void request_mode(std::uint8_t request);
  void update_mode();
  [[nodiscard]] bool may_change_mode() const;
  void enter_mode(OperationMode mode);
  void listen();
  void forget_errors();
  void wake_up();
  void apply_bit_timing();
  [[nodiscard]] NodeTiming timing() const;
  [[nodiscard]] bool timing_is_valid() const;
  /// Unless a reset comes first.
  void later(SimTime span, std::function<void()> action);

  // transmission
  void request_transmission(int buffer);
  void take_back(int buffer);
  void abort_all();
  void give_up(int buffer, std::uint8_t flags);
  [[nodiscard]] bool is_pending(int buffer) const;
  void end_attempt(std::uint8_t error_flag);
  [[nodiscard]] int next_buffer() const;
  [[nodiscard]] Frame transmit_frame(int buffer) const;
  void transmission_done(const Frame& frame);
  [[nodiscard]] bool is_looping_back() const;
  void start_loopback();
  void finish_loopback(const Frame& frame);

  // reception
  void assemble(const Frame& frame);
  void offer_to_rxb0(const Frame& frame, int filter);
  void offer_to_rxb1(const Frame& frame, int filter, std::uint8_t overflow_flag);
  [[nodiscard]] bool is_full(int buffer) const;
  void store(const Frame& frame, int buffer, int filter);
  void overflow(std::uint8_t flag);
  [[nodiscard]] bool takes_everything() const;
  [[nodiscard]] int matching_filter(const Frame& frame, int buffer) const;
  [[nodiscard]] bool filter_matches(const Frame& frame, int filter) const;
  [[nodiscard]] std::uint32_t identifier_at(std::uint8_t address) const;

  // ControllerClient
  std::optional<Submission> next_submission() override;
  void on_transmitted() override;
  void on_arbitration_lost() override;
  void on_transmit_error(BusError error) override;
  void on_received(const Frame& frame) override;
  void on_receive_error(BusError error) override;
  void on_confinement_changed() override;
  void on_integrated() override;
  void on_bus_activity() override;

  CanBus& bus_;
  Mcp2515Options options_;
  Controller controller_;
  std::array<std::uint8_t, 128> registers_{};
  bool running_ = false;  // the oscillator has started up
  bool selected_ = false;
  Instruction instruction_{};
  OperationMode mode_ = OperationMode::configuration;
  std::optional<OperationMode> entering_;  // once the bus has been idle for 11 bits
  int on_wire_ = -1;                       // the buffer whose frame is being sent
  std::array<SimTime, 3> requested_at_{};
  std::array<bool, 3> rts_pins_{true, true, true};
  std::uint8_t error_bits_ = 0;  // EFLG's lower six as they were last told
  std::array<std::uint8_t, max_data_length> assembled_{};
  std::shared_ptr<const void> era_;  // since the last reset: what was to happen later dies with it
  bool pin_ = true;
  std::function<void(bool)> pin_listener_;
  std::function<void(const Frame&)> accepted_listener_;
  std::function<void(const Frame&)> sent_listener_;
  Mcp2515Events events_;
  std::vector<Mcp2515Violation> violations_;
  std::uint64_t violation_count_ = 0;
};

const char* to_string(Mcp2515Chip::OperationMode mode);

}  // namespace roio::sim

#endif
