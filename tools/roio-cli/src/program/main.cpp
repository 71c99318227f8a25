/// roio-cli: a person's, and a script's, way onto a Roio bus. Documented in docs/cli.md.
#include <signal.h>
#include <string_view>

#include <variant>

#include "program/command_line.hpp"
#include "program/exit_status.hpp"
#include "program/interrupt.hpp"
#include "program/output.hpp"
#include "program/process.hpp"

namespace roio::cli {
namespace {

int run(const Information& information) {
  Buffer out;
  out.append(std::string_view(information.text));
  flush(out);
  return exit_success;
}
// What runs until a signal, or for as long as a bus takes, ends cleanly by one: also,
// where there are last words to be said, when its terminal goes away.
int run(const SendOptions& options) {
  const Interrupt interrupt;
  return send(options);
}
int run(const AskOptions& options) {
  const Interrupt interrupt;
  return ask(options);
}
int run(const DumpOptions& options) {
  const Interrupt interrupt;
  Interrupt::also(SIGHUP);
  return dump(options);
}
int run(const TopOptions& options) {
  const Interrupt interrupt;
  return top(options);
}
int run(const GenOptions& options) {
  const Interrupt interrupt;
  return gen(options);
}
int run(const CheckOptions& options) {
  const Interrupt interrupt;
  return check(options);
}
int run(const RecordOptions& options) {
  const Interrupt interrupt;
  Interrupt::also(SIGHUP);
  return record(options);
}
int run(const PlayOptions& options) {
  const Interrupt interrupt;
  return play(options);
}
int run(const HubOptions& options) {
  const Interrupt interrupt;
  return hub(options);
}
int run(const AttachOptions& options) {
  const Interrupt interrupt;
  Interrupt::also(SIGHUP);
  return attach(options);
}
// What is over in moments is just ended.
int run(const BusesOptions& options) {
  return buses(options);
}
int run(const BridgeShowOptions& options) {
  return bridge_show(options);
}
int run(const BridgeSetOptions& options) {
  return bridge_set(options);
}
int run(const BridgeIdentifyOptions& options) {
  return bridge_identify(options);
}
int run(const KindOptions& options) {
  return make_from_kind(options);
}
int run(const RobotDbcOptions& options) {
  return make_dbc(options);
}
int run(const RobotCheckOptions& options) {
  return check_robot(options);
}

}  // namespace
}  // namespace roio::cli

int main(int argc, char** argv) {
  return roio::cli::run_process("roio-cli", [&] {
    return std::visit([](const auto& command) { return roio::cli::run(command); },
                      roio::cli::parse_command_line(argc, argv));
  });
}
