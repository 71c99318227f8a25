/// Which messages answer a question. Pure functions.
#ifndef ROIO_CLI_ANSWER_HPP
#define ROIO_CLI_ANSWER_HPP

#include <roio/bus.hpp>
#include <roio/filter_socketcan.hpp>
#include <roio/message.hpp>
#include <vector>

namespace roio::cli {

/// From whom the question goes to (of a broadcast, from anybody in that subnet), to who asks.
std::vector<SocketCanFilter> answer_filters(const Message& question);

/// Whether a frame is an answer: such a message, and on the bus after the question was asked, or
/// less than 50 ms before, as clocks may differ. What was on its way before answers something else.
/// @param asked before the question was handed to the bus.
bool is_answer(const Received& received, const Message& question, Timestamp asked);

}  // namespace roio::cli

#endif
