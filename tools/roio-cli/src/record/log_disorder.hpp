/// How far the times of a log may be out of order.
#ifndef ROIO_CLI_LOG_DISORDER_HPP
#define ROIO_CLI_LOG_DISORDER_HPP

#include <chrono>

namespace roio::cli {

/// Frames of several buses may stand in a log in the order in which they were read.
inline constexpr std::chrono::seconds log_disorder{1};

}  // namespace roio::cli

#endif
