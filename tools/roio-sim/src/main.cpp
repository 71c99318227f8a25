/// roio-sim: firmware on simulated boards, on a bus that every Roio program can join. Documented in
/// docs/roio-sim.md.
#include <string_view>
#include <variant>

#include "command_line.hpp"
#include "interrupt.hpp"
#include "program/exit_status.hpp"
#include "program/process.hpp"
#include "report.hpp"
#include "simulation.hpp"
#include "sketch.hpp"

namespace roio::sim_tool {
namespace {

int run(const Information& information) {
  Buffer out;
  out.append(std::string_view(information.text));
  cli::flush(out);
  return cli::exit_success;
}
int run(Options options) {
  catch_signals();
  const int status = build_sketches(options.boards);
  return status != 0 ? status : simulate(options);
}

}  // namespace
}  // namespace roio::sim_tool

int main(int argc, char** argv) {
  return roio::cli::run_process("roio-sim", [&] {
    return std::visit([](const auto& wish) { return roio::sim_tool::run(wish); },
                      roio::sim_tool::parse_command_line(argc, argv));
  });
}
