/// What every tool does around its work: signals, descriptors, and the exit status.
#ifndef ROIO_CLI_PROCESS_HPP
#define ROIO_CLI_PROCESS_HPP

#include <functional>
#include <string_view>

namespace roio::cli {

/// Does a tool's work and tells on standard error, under the tool's name, what went wrong.
/// @return what `work` returns, or the exit status for what it threw (exit_status.hpp).
int run_process(std::string_view tool, const std::function<int()>& work);

/// SIGINT and SIGTERM go to the handler, each once: a second one ends the process. SIGPIPE is
/// ignored, so that writing says it.
void catch_interrupts(void (*handler)(int));
/// A further signal, in the same way.
void catch_interrupt(int number, void (*handler)(int));
/// From now on these end the process again.
void release_interrupts();

}  // namespace roio::cli

#endif
