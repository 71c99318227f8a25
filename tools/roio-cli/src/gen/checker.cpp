#include "gen/checker.hpp"

#include <fmt/format.h>

#include <roio/text.hpp>

#include "form/record_format.hpp"

namespace roio::cli {

void Sequence::add(const Numbered& numbered) {
  ++counts_.received;
  if (span_ == 0) {
    const std::uint32_t mask = numbered.bits < 32 ? (1U << numbered.bits) - 1U : ~0U;
    counts_.first = numbered.number & mask;
    begin(counts_.first);
    return;
  }
  const std::uint32_t number = whole(numbered);
  const auto ahead = static_cast<std::int32_t>(number - counts_.last);
  if (ahead > 0) {
    go_on(number);
  } else {
    look_back(number, counts_.last - number);
  }
}

// The bits that a short message has no room for are those that bring it closest to the highest.
std::uint32_t Sequence::whole(const Numbered& numbered) const {
  const unsigned missing = 32U - numbered.bits;
  const auto distance =
      static_cast<std::int32_t>((numbered.number - counts_.last) << missing) >> missing;
  return counts_.last + static_cast<std::uint32_t>(distance);
}

void Sequence::begin(std::uint32_t number) {
  seen_.reset();
  seen_.set(number % window);
  counts_.last = number;
  span_ = 1;
  run_ = 0;
}

void Sequence::go_on(std::uint32_t number) {
  run_ = 0;
  const std::uint32_t step = number - counts_.last;
  counts_.lost += step - 1;
  span_ += step;
  if (step >= window) {
    seen_.reset();
  } else {
    for (std::uint32_t i = counts_.last + 1; i != number; ++i) {
      seen_.reset(i % window);
    }
  }
  seen_.set(number % window);
  counts_.last = number;
}

void Sequence::look_back(std::uint32_t number, std::uint32_t back) {
  if (back >= window) {
    look_far_back(number);
    return;
  }
  run_ = 0;
  if (seen_.test(number % window)) {
    ++counts_.doubled;
    return;
  }
  ++counts_.out_of_order;
  seen_.set(number % window);
  // What came before the first one was never missed.
  if (back < span_ && counts_.lost > 0) {
    --counts_.lost;
  }
}

// Nobody knows any more whether it had come. Until some in a row say that the generator began anew
// they are late.
void Sequence::look_far_back(std::uint32_t number) {
  ++counts_.out_of_order;
  if (number >= window) {
    run_ = 0;
    return;
  }
  run_ = run_ > 0 && number == run_next_ ? run_ + 1 : 1;
  run_next_ = number + 1;
  if (run_ == restart_run) {
    counts_.out_of_order -= restart_run;
    ++counts_.restarts;
    begin(number - (restart_run - 1));
    while (counts_.last != number) {
      go_on(counts_.last + 1);
    }
  }
}

bool Checker::add(const Message& message) {
  const auto numbered = read_numbered({message.data, message.length});
  if (!numbered) {
    ++others_;
    return false;
  }
  const Generator generator = numbered->generator;
  const Address source = generator.roams ? Address{} : message.header.source;
  const Key key{source.subnet, source.node, generator.id, generator.roams};
  if (sequences_.size() == max_generators && !sequences_.contains(key)) {
    ++others_;
    return false;
  }
  sequences_[key].add(*numbered);
  return true;
}

std::vector<Checker::Report> Checker::reports() const {
  std::vector<Report> reports;
  for (const auto& [key, sequence] : sequences_) {
    const auto& [subnet, node, id, roams] = key;
    reports.push_back({{subnet, node}, {id, roams}, sequence.counts()});
  }
  return reports;
}

SequenceCounts Checker::total() const {
  SequenceCounts total;
  for (const auto& [key, sequence] : sequences_) {
    const SequenceCounts& counts = sequence.counts();
    total.received += counts.received;
    total.lost += counts.lost;
    total.doubled += counts.doubled;
    total.out_of_order += counts.out_of_order;
    total.restarts += counts.restarts;
  }
  return total;
}

bool Checker::failed() const {
  const SequenceCounts counts = total();
  return counts.lost > 0 || counts.doubled > 0 || counts.out_of_order > 0;
}

std::string to_string(const Checker::Report& report) {
  const SequenceCounts& counts = report.counts;
  std::string text =
      fmt::format("{} #{}: {} received, from number {}, {} lost, {} doubled, {} out of order",
                  report.generator.roams ? "any" : to_string(report.source), report.generator.id,
                  counts.received, counts.first, counts.lost, counts.doubled, counts.out_of_order);
  if (counts.restarts > 0) {
    text += ", began anew " + count_of(counts.restarts, "time");
  }
  return text;
}

}  // namespace roio::cli
