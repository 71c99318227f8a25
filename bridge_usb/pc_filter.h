/// PcFilter: which of the bus's frames the PC wants. Those that one of its rules lets through; at
/// first all.
/// Source: docs/internals/serial-protocol.md "Control records, down", FILTER.
#ifndef ROIO_BRIDGE_PC_FILTER_H
#define ROIO_BRIDGE_PC_FILTER_H

#include "config.h"

namespace roio {
namespace bridge {

class PcFilter {
 public:
  PcFilter() : everything_passes_(true), rule_count_(0), rules_() {}

  /// @param payload FILTER's, from the number of rules on.
  /// @return bad_argument: no such payload, and nothing has changed.
  Status set(const uint8_t* payload, uint8_t length) {
    const uint8_t count = length == 0 ? uint8_t{0xFF} : payload[0];
    if (count > serial::max_rules || length != 1 + count * sizeof(Rule)) {
      return Status::bad_argument;
    }
    rule_count_ = count;
    everything_passes_ = false;
    ++payload;
    for (uint8_t i = 0; i < count; ++i) {
      rules_[i].match = serial::get32(payload);
      rules_[i].mask = serial::get32(payload + 4);
      payload += sizeof(Rule);
      everything_passes_ = everything_passes_ || rules_[i].mask == 0;
    }
    return Status::ok;
  }

  bool everything_passes() const { return everything_passes_; }
  /// @param tag_bytes with which the frame's record begins.
  ROIO_BRIDGE_FAST bool passes(const uint8_t* tag_bytes) const {
    const uint32_t tag = serial::get32(tag_bytes);
    for (uint8_t i = 0; i < rule_count_; ++i) {
      if (((tag ^ rules_[i].match) & rules_[i].mask) == 0) {
        return true;
      }
    }
    return false;
  }

 private:
  struct Rule {
    uint32_t match;
    uint32_t mask;
  };

  bool everything_passes_;
  uint8_t rule_count_;
  Rule rules_[serial::max_rules];
};

}  // namespace bridge
}  // namespace roio

#endif
