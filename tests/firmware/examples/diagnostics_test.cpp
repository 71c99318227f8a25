// Diagnostics: each fault makes it say its sentence, and when the fault is gone, all is well again.
#include <functional>
#include <optional>

#include "sketch_rig.hpp"

namespace roio::test {
namespace {

constexpr const char* no_chip = "NO CHIP: check CS, SCK, SI and SO (swapped?), 5V and GND.";
constexpr const char* stuck_at_start =
    "BUS STUCK: it is never quiet. Does CANH or CANL touch 5V or GND?";
constexpr const char* stuck =
    "BUS STUCK, OR OTHER RATE: it hears nonsense. Do all nodes run at one rate?";
constexpr const char* bus_off =
    "BUS-OFF: what it sends is not what is on the bus. Do CANH and CANL touch?";
constexpr const char* no_acknowledgement =
    "NO ACKNOWLEDGEMENT: is another node on? At the same rate? CANH to CANH?";
constexpr const char* errors =
    "ERRORS: but it works. 120 ohms at both ends? All at one rate? A loose cable?";
constexpr const char* well = "ALL IS WELL.";

class DiagnosticsRig : public SketchRig {
 public:
  explicit DiagnosticsRig(const sim::BoardOptions& options = {},
                          sim::BoardKind kind = sim::BoardKind::uno)
      : SketchRig(kind, "Diagnostics", options) {}

  /// Past the first report.
  void settle() { ASSERT_EQ(verdicts(2500ms), Texts{well}); }
  /// What it says, without the lines of counters.
  Texts verdicts(sim::SimTime span) {
    Texts result = run_for_lines(span);
    std::erase_if(result, [](const std::string& line) { return line.starts_with("  "); });
    return result;
  }
};

/// Of several seconds: the first may still see how it was before.
void expect_in_the_end(const Texts& verdicts, const std::string& expected) {
  ASSERT_GE(verdicts.size(), 2U);
  for (std::size_t i = 1; i < verdicts.size(); ++i) {
    EXPECT_EQ(verdicts[i], expected) << "second " << i;
  }
}

TEST(Diagnostics, AllIsWellAndWhatWasCounted) {
  DiagnosticsRig rig;
  EXPECT_EQ(
      rig.run_for_lines(3500ms),
      (Texts{well,
             "  sent 1, received 0, lost 0, bus-offs 0; error-active, error counters 0 transmit, 0 "
             "receive; INT connected",
             well,
             "  sent 2, received 0, lost 0, bus-offs 0; error-active, error counters 0 transmit, 0 "
             "receive; INT connected"}));
  rig.send({0, 250}, {1, 2, 3});
  EXPECT_EQ(rig.run_for_lines(1s),
            (Texts{well,
                   "  sent 3, received 1, lost 0, bus-offs 0; error-active, error counters 0 "
                   "transmit, 0 receive; INT connected"}));
  EXPECT_EQ(rig.received, Texts(4, "0.250 > 0.250:"));
}

TEST(Diagnostics, AllIsWellOnAMega) {
  DiagnosticsRig rig({}, sim::BoardKind::mega);
  EXPECT_EQ(rig.verdicts(3500ms), (Texts{well, well}));
}

// Its Serial is USB, which nobody has opened.
TEST(Diagnostics, SendsItsMessagesOnALeonardo) {
  DiagnosticsRig rig({}, sim::BoardKind::leonardo);
  EXPECT_EQ(rig.run(3500ms), Texts(3, "0.250 > 0.250:"));
}

struct InterruptPin {
  const char* name;
  std::optional<bool> level;
};
class DiagnosticsWithoutInt : public testing::TestWithParam<InterruptPin> {};
INSTANTIATE_TEST_SUITE_P(, DiagnosticsWithoutInt,
                         testing::Values(InterruptPin{"NotWired", std::nullopt},
                                         InterruptPin{"StuckHigh", true},
                                         InterruptPin{"StuckLow", false}),
                         [](const auto& row) { return row.param.name; });

TEST_P(DiagnosticsWithoutInt, SaysSoAndGetsEveryMessage) {
  sim::BoardOptions options;
  options.interrupt_pin = std::nullopt;
  DiagnosticsRig rig(options);
  if (GetParam().level) {
    rig.board.set_pin(2, *GetParam().level);
  }
  rig.settle();
  for (std::uint8_t i = 0; i < 20; ++i) {
    rig.send({0, 250}, {i, 2, 3, 4, 5, 6, 7, 8});
  }
  const Texts lines = rig.run_for_lines(1s);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0], well);
  EXPECT_EQ(lines[1],
            "  sent 2, received 20, lost 0, bus-offs 0; error-active, error counters 0 transmit, 0 "
            "receive; INT not connected");
}

TEST(Diagnostics, NoChip) {
  sim::BoardOptions options;
  options.has_chip = false;
  DiagnosticsRig rig(options);
  EXPECT_EQ(rig.run_for_lines(3500ms), Texts(3, no_chip));
}

struct Crystal {
  std::uint32_t hz;
  const char* said;
};
class DiagnosticsOfCrystals : public testing::TestWithParam<Crystal> {};
INSTANTIATE_TEST_SUITE_P(, DiagnosticsOfCrystals,
                         testing::Values(Crystal{8'000'000, "8"}, Crystal{10'000'000, "10"},
                                         Crystal{12'000'000, "12"}, Crystal{20'000'000, "20"}),
                         [](const auto& row) { return row.param.said; });

TEST_P(DiagnosticsOfCrystals, IsToldWhichItIs) {
  sim::BoardOptions options;
  options.chip.osc_hz = GetParam().hz;
  DiagnosticsRig rig(options);
  EXPECT_EQ(rig.run_for_lines(2500ms),
            Texts(2, std::string("WRONG CRYSTAL: about ") + GetParam().said +
                         " MHz, and this sketch says 16. Change the line with crystal."));
  EXPECT_EQ(rig.pc.receive_errors_seen(), 0U) << "nothing of the wrong rate on the bus";
}

struct Fault {
  const char* name;
  const char* said;
  std::function<void(DiagnosticsRig&)> begin;
  std::function<void(DiagnosticsRig&)> end;
};
void PrintTo(const Fault& fault, std::ostream* out) {
  *out << fault.name;
}

const Fault faults[] = {
    {"ChipUnplugged", no_chip,
     [](auto& rig) { rig.board.set_chip_fault(sim::SpiWire::Fault::stuck_high); },
     [](auto& rig) { rig.board.set_chip_fault(sim::SpiWire::Fault::none); }},
    {"ChipWithoutAnswer", no_chip,
     [](auto& rig) { rig.board.set_chip_fault(sim::SpiWire::Fault::stuck_low); },
     [](auto& rig) { rig.board.set_chip_fault(sim::SpiWire::Fault::none); }},
    {"Alone", no_acknowledgement,
     [](auto& rig) { rig.pc.controller().set_mode(sim::Controller::Mode::off); },
     [](auto& rig) { rig.pc.controller().set_mode(sim::Controller::Mode::normal); }},
    {"StuckWhileIdle", stuck, [](auto& rig) { rig.bus.hold_dominant(true); },
     [](auto& rig) { rig.bus.hold_dominant(false); }},
    {"StuckWhileItSends", bus_off,
     [](auto& rig) {
       while (!rig.board.chip().controller().transmitting()) {
         rig.bus.run_for(2us);
       }
       rig.bus.run_for(100us);  // past the identifier, where it would only lose arbitration
       rig.bus.hold_dominant(true);
     },
     [](auto& rig) { rig.bus.hold_dominant(false); }},
    {"ShortCircuit", bus_off,
     [](auto& rig) { rig.board.chip().controller().cut_transmitter(true); },
     [](auto& rig) { rig.board.chip().controller().cut_transmitter(false); }},
    {"BadCable", errors,
     [](auto& rig) {
       rig.bus.set_bit_errors(0.01, 1);
       for (int i = 0; i < 3000; ++i) {
         rig.send({0, 2}, Bytes(8, 1));
       }
     },
     [](auto& rig) { rig.bus.set_bit_errors(0, 1); }},
};

class DiagnosticsOfFaults : public testing::TestWithParam<Fault> {};
INSTANTIATE_TEST_SUITE_P(, DiagnosticsOfFaults, testing::ValuesIn(faults),
                         [](const auto& row) { return row.param.name; });

TEST_P(DiagnosticsOfFaults, IsSaidAndThenAllIsWellAgain) {
  DiagnosticsRig rig;
  rig.settle();
  GetParam().begin(rig);
  expect_in_the_end(rig.verdicts(3s), GetParam().said);
  GetParam().end(rig);
  expect_in_the_end(rig.verdicts(3s), well);
}

// Longer than the message of a second takes, and over before the next report.
TEST(Diagnostics, ABusOffThatIsOverIsToldOnce) {
  DiagnosticsRig rig;
  rig.settle();
  rig.board.chip().controller().cut_transmitter(true);
  rig.bus.run_for(550ms);
  rig.board.chip().controller().cut_transmitter(false);
  EXPECT_EQ(rig.verdicts(2s), (Texts{bus_off, well}));
}

TEST(Diagnostics, BusStuckFromTheStart) {
  DiagnosticsRig rig;
  rig.bus.hold_dominant(true);
  EXPECT_EQ(rig.run_for_lines(3500ms), Texts(3, stuck_at_start));
  rig.bus.hold_dominant(false);
  expect_in_the_end(rig.verdicts(3s), well);
}

// With nobody else, neither gets anything through; who gives up first, and how, depends on the
// rates.
TEST(Diagnostics, OnlyANodeAtAnotherRate) {
  for (const std::uint32_t rate : {125'000U, 250'000U, 1'000'000U}) {
    SCOPED_TRACE(rate);
    DiagnosticsRig rig;
    rig.pc.controller().set_mode(sim::Controller::Mode::off);
    sim::HostNode other(rig.bus, rate);
    other.send(frame_of({0, 5}, {0, 6}, {1}));
    const Texts verdicts = rig.verdicts(4500ms);
    ASSERT_EQ(verdicts.size(), 3U);
    for (const std::string& verdict : verdicts) {
      EXPECT_TRUE(verdict == stuck || verdict == bus_off || verdict == no_acknowledgement)
          << verdict;
    }
  }
}

TEST(Diagnostics, ANodeAtAnotherRateBesideOthers) {
  DiagnosticsRig rig;
  sim::HostNode other(rig.bus, 250'000);
  EXPECT_EQ(rig.verdicts(4500ms), Texts(3, errors));
}

// Its error counter stays high for a while, but that is the past.
TEST(Diagnostics, TellsTheStateBesideTheVerdict) {
  DiagnosticsRig rig;
  rig.settle();
  rig.pc.controller().set_mode(sim::Controller::Mode::off);
  const Texts alone = rig.run_for_lines(3s);
  ASSERT_EQ(alone.size(), 6U);
  EXPECT_EQ(
      alone.back(),
      "  sent 2, received 0, lost 0, bus-offs 0; error-passive, error counters 128 transmit, 0 "
      "receive; INT connected");
  rig.pc.controller().set_mode(sim::Controller::Mode::normal);
  const Texts again = rig.run_for_lines(3s);
  ASSERT_EQ(again.size(), 6U);
  EXPECT_EQ(again[4], well);
  EXPECT_EQ(
      again[5],
      "  sent 6, received 0, lost 0, bus-offs 0; error-active, with a warning, error counters "
      "124 transmit, 0 receive; INT connected");
}

}  // namespace
}  // namespace roio::test
