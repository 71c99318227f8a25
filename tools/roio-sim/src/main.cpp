/// roio-sim: firmware on simulated boards, on a bus that every Roio program can join. Documented in
/// docs/roio-sim.md.
#include <fcntl.h>
#include <unistd.h>

#include <exception>
#include <roio/error.hpp>
#include <system_error>
#include <variant>

#include "command_line.hpp"
#include "exit_status.hpp"
#include "interrupt.hpp"
#include "report.hpp"
#include "simulation.hpp"

namespace roio::sim_tool {
namespace {

int run(const Information& information) {
  Buffer out;
  out.append(std::string_view(information.text));
  cli::flush(out);
  return cli::exit_success;
}
int run(const Options& options) {
  catch_signals();
  return simulate(options);
}

// Whether the bus that was asked for cannot be had, however often one tries.
bool is_wrong_bus(const std::error_code& code) {
  return code == Errc::bad_url || code == Errc::no_such_interface ||
         code == Errc::not_a_can_interface || code == Errc::no_can_support ||
         code == Errc::not_supported || code == Errc::bitrate_mismatch;
}

int run(int argc, const char* const* argv) {
  constexpr int broken_pipe_signal = 13;
  try {
    return std::visit([](const auto& wish) { return run(wish); }, parse_command_line(argc, argv));
  } catch (const cli::BrokenPipe&) {
    return cli::exit_signal + broken_pipe_signal;
  } catch (const cli::UsageError& error) {
    note(error.what());
    return cli::exit_usage;
  } catch (const std::system_error& error) {
    note(error.what());
    return is_wrong_bus(error.code()) ? cli::exit_usage : cli::exit_failure;
  } catch (const std::exception& error) {
    note(error.what());
    return cli::exit_failure;
  }
}

// A standard descriptor that was closed (`<&-`) would become the next thing opened: a bus's socket,
// which then got what is printed. What stands in for it fails as a closed one does.
void reserve_standard_descriptors() {
  for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(fd, F_GETFD) == -1) {
      static_cast<void>(::open("/dev/null", fd == STDIN_FILENO ? O_WRONLY : O_RDONLY));
    }
  }
}

}  // namespace
}  // namespace roio::sim_tool

int main(int argc, char** argv) {
  roio::sim_tool::reserve_standard_descriptors();
  return roio::sim_tool::run(argc, argv);
}
