#include "program/process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <exception>
#include <roio/error.hpp>
#include <system_error>

#include "program/exit_status.hpp"
#include "program/output.hpp"

namespace roio::cli {
namespace {

// Whether the bus that was asked for cannot be had, however often one tries.
bool is_wrong_bus(const std::error_code& code) {
  return code == Errc::bad_url || code == Errc::no_such_interface ||
         code == Errc::not_a_can_interface || code == Errc::no_can_support ||
         code == Errc::not_supported || code == Errc::bitrate_mismatch ||
         code == Errc::no_such_port || code == Errc::not_a_port || code == Errc::several_bridges ||
         code == Errc::relative_path;
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

void handle(int number, void (*handler)(int), int flags) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  sigemptyset(&action.sa_mask);
  sigaction(number, &action, nullptr);
}

}  // namespace

int run_process(std::string_view tool, const std::function<int()>& work) {
  constexpr int broken_pipe_signal = 13;
  reserve_standard_descriptors();
  try {
    return work();
  } catch (const BrokenPipe&) {
    return exit_signal + broken_pipe_signal;
  } catch (const UsageError& error) {
    tell(tool, error.what());
    return exit_usage;
  } catch (const std::system_error& error) {
    tell(tool, error.what());
    return is_wrong_bus(error.code()) ? exit_usage : exit_failure;
  } catch (const std::exception& error) {
    tell(tool, error.what());
    return exit_failure;
  }
}

void catch_interrupt(int number, void (*handler)(int)) {
  handle(number, handler, static_cast<int>(SA_RESETHAND));
}

void catch_interrupts(void (*handler)(int)) {
  catch_interrupt(SIGINT, handler);
  catch_interrupt(SIGTERM, handler);
  handle(SIGPIPE, SIG_IGN, 0);
}

void release_interrupts() {
  handle(SIGINT, SIG_DFL, 0);
  handle(SIGTERM, SIG_DFL, 0);
}

}  // namespace roio::cli
