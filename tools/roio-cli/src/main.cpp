/// roio-cli: a person's, and a script's, way onto a Roio bus. Documented in docs/cli.md.
#include <fcntl.h>
#include <unistd.h>

#include <exception>
#include <roio/error.hpp>
#include <string_view>
#include <system_error>
#include <variant>

#include "command_line.hpp"
#include "exit_status.hpp"
#include "interrupt.hpp"
#include "output.hpp"

namespace roio::cli {
namespace {

int run(const Information& information) {
  Buffer out;
  out.append(std::string_view(information.text));
  flush(out);
  return exit_success;
}
int run(const SendOptions& options) {
  const Interrupt interrupt;
  return send(options);
}
int run(const DumpOptions& options) {
  const Interrupt interrupt;
  return dump(options);
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
    return std::visit([](const auto& command) { return run(command); },
                      parse_command_line(argc, argv));
  } catch (const BrokenPipe&) {
    return exit_signal + broken_pipe_signal;
  } catch (const UsageError& error) {
    note(error.what());
    return exit_usage;
  } catch (const std::system_error& error) {
    note(error.what());
    return is_wrong_bus(error.code()) ? exit_usage : exit_failure;
  } catch (const std::exception& error) {
    note(error.what());
    return exit_failure;
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
}  // namespace roio::cli

int main(int argc, char** argv) {
  roio::cli::reserve_standard_descriptors();
  return roio::cli::run(argc, argv);
}
