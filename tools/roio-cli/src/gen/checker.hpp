/// Checker: what became of numbered messages: which came, which did not, which came twice, which
/// came late. Pure: messages go in, counts come out. Generators are told apart by source address
/// and id, those whose source varies by their id.
#ifndef ROIO_CLI_CHECKER_HPP
#define ROIO_CLI_CHECKER_HPP

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <map>
#include <roio/address.hpp>
#include <roio/message.hpp>
#include <string>
#include <tuple>
#include <vector>

#include "gen/numbered.hpp"

namespace roio::cli {

struct SequenceCounts {
  std::uint32_t first = 0;  ///< The number that was the first to come.
  std::uint32_t last = 0;   ///< The highest so far.
  std::uint64_t received = 0;
  std::uint64_t lost = 0;          ///< Numbers left out, and not come since within the window.
  std::uint64_t doubled = 0;       ///< Numbers that had come already.
  std::uint64_t out_of_order = 0;  ///< Numbers that came after higher ones.
  std::uint64_t restarts = 0;      ///< Times that it went back so far that it began anew.
};

/// The numbers of one generator.
class Sequence {
 public:
  /// How far back a number may lie and still be told as late or doubled. One that lies further back
  /// is late.
  static constexpr std::size_t window = 4096;
  /// So many numbers, one after the other, that lie further back and are among the first `window`:
  /// then the generator began anew. Fewer are stragglers.
  static constexpr std::uint32_t restart_run = 3;

  void add(const Numbered& numbered);
  [[nodiscard]] const SequenceCounts& counts() const { return counts_; }

 private:
  [[nodiscard]] std::uint32_t whole(const Numbered& numbered) const;
  void begin(std::uint32_t number);
  void go_on(std::uint32_t number);
  void look_back(std::uint32_t number, std::uint32_t back);
  void look_far_back(std::uint32_t number);

  SequenceCounts counts_;
  std::bitset<window> seen_;    // of the numbers up to the highest, by number % window
  std::uint64_t span_ = 0;      // numbers from the first to the highest, since it began (anew)
  std::uint32_t run_ = 0;       // numbers that may be those of a generator that began anew
  std::uint32_t run_next_ = 0;  // the one that would go on with them
};

class Checker {
 public:
  /// Generators there is room for; messages of any others count as others().
  static constexpr std::size_t max_generators = 256;

  struct Report {
    Address source;  ///< Of one that roams, any.
    Generator generator;
    SequenceCounts counts;
  };

  /// @return false: it is none of a generator's, and counts as an other.
  bool add(const Message& message);

  /// In the order of their addresses.
  [[nodiscard]] std::vector<Report> reports() const;
  /// Of all generators together; first and last mean nothing then.
  [[nodiscard]] SequenceCounts total() const;
  /// Messages that are not numbered, or damaged.
  [[nodiscard]] std::uint64_t others() const { return others_; }
  /// Whether anything was lost, doubled or out of order.
  [[nodiscard]] bool failed() const;

 private:
  using Key = std::tuple<std::uint8_t, std::uint8_t, std::uint8_t, bool>;  // source, generator

  std::map<Key, Sequence> sequences_;
  std::uint64_t others_ = 0;
};

/// "0.10 #7: 1000 received, from number 0, 2 lost, 0 doubled, 0 out of order".
std::string to_string(const Checker::Report& report);

}  // namespace roio::cli

#endif
