// What a node costs an Uno in time, from real images on simulated boards: the same figures in every
// run, whatever else the machine does. Prints tables as bench/figures.md has them; exits with 1
// when a message was lost.
//
//   firmware_bench [SIMULATED_SECONDS]   on the saturated bus of 1 Mbit/s; others: a sixth of it
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "call_time.hpp"
#include "saturation.hpp"

namespace roio::load {
namespace {

constexpr double mhz = 16;

void print_call_times() {
  constexpr struct {
    const char* image;
    const char* name;
  } nodes[] = {{"CallTimePolled", "`RoioOn<10>`"},
               {"CallTimeInterrupt", "`RoioOn<10, 2>`: interrupt pin"},
               {"CallTimeSetPin", "`Roio roio(10)`"},
               {"CallTimeClassic", "the same, calls of 2014"},
               {"CallTimePortable", "`RoioOn<10>`, portable pins"}};
  std::printf(
      "us | data | receive: usual | receive: longest | in a run: shortest | nothing there | "
      "send\n");
  for (const auto& node : nodes) {
    for (const int length : {0, 8}) {
      const CallTimeReport lone = measure_calls(node.image, length, 400, false);
      const CallTimeReport pairs = measure_calls(node.image, length, 400, true);
      std::printf("| %s | %d | %.1f | %.1f | %.1f | %.1f | %.1f |\n", node.name, length,
                  usual(lone.receive) / mhz, longest(lone.receive) / mhz,
                  shortest(pairs.receive) / mhz, usual(lone.nothing) / mhz, usual(lone.send) / mhz);
    }
  }
}

struct Bus {
  const char* image;
  const char* name;
  std::uint32_t bitrate_bps;
  std::uint32_t osc_hz;
};

bool print_saturation(const Bus& bus, int length, std::chrono::seconds span) {
  const SaturationCase load{bus.image, bus.bitrate_bps, bus.osc_hz, length};
  const SaturationReport report = saturate(load, span);
  const double idle = left_over_when_idle(load, std::chrono::seconds(1));
  const bool good = report.bus_load > 0.99 && report.received == report.sent &&
                    report.overflowed == 0 && report.disordered == 0 && report.wrong == 0;
  std::printf("| %s | %d | %.1f | %.3f | %llu | %llu | %s | %.0f %% | %.0f %% | %.0f %% |\n",
              bus.name, length, report.frame_us, report.bus_load,
              static_cast<unsigned long long>(report.sent),
              static_cast<unsigned long long>(report.sent - report.received),
              report.disordered == 0 ? "in order" : "DISORDERED", 100 * report.left_over,
              100 * idle, 100 * report.left_over / idle);
  static_cast<void>(std::fflush(stdout));
  return good;
}

bool print_saturations(std::chrono::seconds longest_span) {
  constexpr std::uint32_t mhz_16 = 16'000'000;
  constexpr std::uint32_t mhz_8 = 8'000'000;
  constexpr Bus buses[] = {
      {"SaturatedPolled1000", "1 Mbit/s", 1'000'000, mhz_16},
      {"SaturatedInterrupt1000", "1 Mbit/s, interrupt pin", 1'000'000, mhz_16},
      {"SaturatedPolled500", "500 kbit/s", 500'000, mhz_16},
      {"SaturatedInterrupt500", "500 kbit/s, interrupt pin", 500'000, mhz_16},
      {"SaturatedPolled500At8", "500 kbit/s, 8 MHz crystal", 500'000, mhz_8},
      {"SaturatedInterrupt500At8", "the same, interrupt pin", 500'000, mhz_8},
      {"SaturatedPolled250", "250 kbit/s", 250'000, mhz_16},
      {"SaturatedInterrupt250", "250 kbit/s, interrupt pin", 250'000, mhz_16},
      {"SaturatedPolled125", "125 kbit/s", 125'000, mhz_16},
      {"SaturatedInterrupt125", "125 kbit/s, interrupt pin", 125'000, mhz_16},
  };
  std::printf(
      "bus | data | us a frame | bus load | sent | lost | order | left over | by an idle bus | of "
      "that\n");
  bool good = true;
  for (const Bus& bus : buses) {
    for (const int length : {0, 8}) {
      const auto span = bus.bitrate_bps == 1'000'000 ? longest_span : longest_span / 6;
      good = print_saturation(bus, length, span) && good;
    }
  }
  return good;
}

bool print_all(std::chrono::seconds longest_span) {
  print_call_times();
  std::printf("\n");
  return print_saturations(longest_span);
}

}  // namespace
}  // namespace roio::load

int main(int argc, char** argv) {
  const std::chrono::seconds span(argc > 1 ? std::strtol(argv[1], nullptr, 10) : 60);
  return roio::load::print_all(span) ? 0 : 1;
}
