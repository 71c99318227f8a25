/// The FILTER words of `roio-cli dump`, compiled to SocketCAN filters. A pure function.
///
///   to=0.2      messages to node 0.2          to=0.*      broadcasts to subnet 0
///   to=0.any    to any node of subnet 0, or to all of it
///   from=0.3    from node 0.3                 from=0.any  from any node of subnet 0
///   urgent  normal  class=system              by priority, by class
///   123:7FF     candump's: identifier and mask in hexadecimal, an 8-digit identifier is extended
///   123~7FF     candump's: all but these
///
/// A star is the broadcast address, as everywhere; "any" is every node.
///
/// Words of one kind widen (to=0.2 to=0.*: either), words of different kinds narrow (to=0.2 urgent:
/// both), each ID~MASK takes away, and the word "or" begins a second, independent choice.
/// Source: docs/cli.md "Filters".
#ifndef ROIO_CLI_FILTER_WORDS_HPP
#define ROIO_CLI_FILTER_WORDS_HPP

#include <cstddef>
#include <roio/filter_socketcan.hpp>
#include <roio/text.hpp>
#include <span>
#include <string>
#include <vector>

namespace roio::cli {

/// What a bus takes (Bus::set_filters()).
inline constexpr std::size_t max_kernel_filters = 512;

/// Compiles filter words; the result accepts exactly the frames that the words mean, and no words
/// mean every frame.
/// @param roio_only leaves out all that is not an extended data frame.
/// @return 1..512 filters, any of which lets a frame through; or an error that quotes the word and
///         says what was expected, that no frame can satisfy the words, or that they need more
///         filters than there are.
Parsed<std::vector<SocketCanFilter>> compile_filter_words(std::span<const std::string> words,
                                                          bool roio_only = false);

}  // namespace roio::cli

#endif
