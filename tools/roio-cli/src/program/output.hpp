/// Standard output in whole batches, and standard error in whole lines.
#ifndef ROIO_CLI_OUTPUT_HPP
#define ROIO_CLI_OUTPUT_HPP

#include <string_view>

#include "form/frame_text.hpp"

namespace roio::cli {

/// The reader of our standard output has gone; nothing is left to do, and nothing to say.
struct BrokenPipe {};

/// Writes all of the buffer with as few calls as there can be, and empties it.
/// @throws BrokenPipe; Failure for any other error (a full disk).
void flush(Buffer& out);

/// Whether nobody reads standard output any more, as a pipe's writer can know without writing.
bool output_is_gone() noexcept;

/// Whether standard output is a terminal whose user has not asked for no colour (NO_COLOR, or a
/// TERM of "dumb").
bool wants_colour() noexcept;

/// One line "roio-cli: TEXT" on standard error.
void note(std::string_view text) noexcept;
/// The same for any tool.
void tell(std::string_view tool, std::string_view text) noexcept;

}  // namespace roio::cli

#endif
