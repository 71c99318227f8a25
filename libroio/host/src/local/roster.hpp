#ifndef ROIO_LOCAL_ROSTER_HPP
#define ROIO_LOCAL_ROSTER_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "local/memory.hpp"
#include "local/readers.hpp"

namespace roio::local {

/// Who is on the bus, as its memory has it: the hub's hand on the slots.
class Roster {
 public:
  /// @param lock_fd of the memory's file, where clients show that they are alive.
  Roster(Memory& memory, int lock_fd, Readers& readers)
      : memory_(memory), lock_fd_(lock_fd), readers_(readers) {}

  /// For each slot, whether its client is connected.
  using Connected = std::array<bool, max_clients>;

  /// Takes over whoever is left of the bus that a hub before has set up, and settles what that one
  /// may not have. @return false: nobody is.
  bool take_over();
  /// Frees the slots of those who are neither connected nor alive. Who is alive is to come over
  /// yet: a stopped process, for one.
  void free_dead(const Connected& connected);

  [[nodiscard]] std::optional<std::size_t> slot_of(std::uint64_t client) const;
  /// Gives a newcomer a slot. @return none: there is no free one.
  std::optional<std::size_t> take_free(std::uint64_t client);

  /// Whether anybody is alive, connected or not.
  [[nodiscard]] bool has_anybody() const noexcept { return has_living_clients(memory_, lock_fd_); }
  /// Whether another than this client is there to carry the bus.
  [[nodiscard]] bool has_host_but(std::uint64_t client) const;

 private:
  void note_done_from_log();

  Memory& memory_;
  int lock_fd_;
  Readers& readers_;
};

}  // namespace roio::local

#endif
