#ifndef ROIO_LOCAL_SLOT_FILTERS_HPP
#define ROIO_LOCAL_SLOT_FILTERS_HPP

#include <cstdint>
#include <roio/filter_socketcan.hpp>
#include <span>
#include <vector>

#include "local/memory.hpp"

namespace roio::local {

/// A client's filters, into its slot. @param filters max_filters at most.
void publish_filters(Slot& slot, std::span<const SocketCanFilter> filters) noexcept;

inline bool accept(std::span<const SocketCanFilter> filters, std::uint32_t tagged) noexcept {
  for (const SocketCanFilter& filter : filters) {
    if (accepts(filter, tagged)) {
      return true;
    }
  }
  return false;
}

/// The hub's copy of them.
class SlotFilters {
 public:
  /// Sees whether they have changed.
  void look(const Slot& slot);
  /// Everything, while the client is changing them: it is a moment, or the client's end.
  [[nodiscard]] bool want(std::uint32_t tagged) const noexcept {
    return changing_ || accept(filters_, tagged);
  }

 private:
  static constexpr std::uint32_t never_looked = 1;  // odd: no version that a copy is of

  std::uint32_t version_ = never_looked;
  bool changing_ = true;
  std::vector<SocketCanFilter> filters_;
};

}  // namespace roio::local

#endif
