#ifndef ROIO_LOCAL_INBOX_HPP
#define ROIO_LOCAL_INBOX_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <roio/bus.hpp>
#include <roio/parts/receive_queue.hpp>
#include <span>
#include <vector>

#include "local/log_reader.hpp"
#include "local/memory.hpp"
#include "local/protocol.hpp"

namespace roio::local {

/// What a client receives: read from the bus's log by its filters, kept until the program takes it.
/// The caller holds the bus's lock for everything but readable().
class Inbox {
 public:
  /// @param client its number: its own frames it does not receive.
  Inbox(std::uint64_t client, std::vector<SocketCanFilter> filters)
      : client_(client), filters_(std::move(filters)) {}

  /// Another hub has let the client in. @param memory of the bus; left alone where it is the one
  /// that the client had.
  void adopt(ClientMemory memory, const Welcome& welcome);
  /// The bus is left: the slot may be another client's from now on. Before the presence ends.
  void end();
  /// Up to where the client's own frames are in a log that is to be left for that of `welcome`; 0:
  /// it is not to be left.
  [[nodiscard]] std::array<std::uint64_t, lane_count> carried_before(const Welcome& welcome) const;
  /// From now on what any of these accepts.
  void set_filters(std::span<const SocketCanFilter> filters);

  /// Reads on in the log. @return false: there was no more, now.
  bool fetch();
  /// See LogReader. Who does not listen is not woken for frames, and must be when it begins to.
  bool sleep() { return !log_ || filters_.empty() || log_->reader.sleep(); }
  void stay_awake();

  /// What the program takes.
  std::size_t take(std::span<Received> frames);
  [[nodiscard]] const EventFlag& readable() const { return queue_.readable(); }
  [[nodiscard]] bool empty() const { return queue_.size() == 0; }
  /// Senders wait for this client, and it has read on: to be told. True once.
  bool must_tell();

  /// The client's slot; null before the first hub.
  [[nodiscard]] Slot* slot() const { return log_ ? &log_->memory.slot() : nullptr; }
  /// Other clients that listen.
  [[nodiscard]] std::size_t listeners() const;
  void add_to(Statistics& statistics) const;
  [[nodiscard]] std::uint64_t dropped() const;

 private:
  struct Log {
    Log(ClientMemory its_memory, const Welcome& welcome)
        : memory(std::move(its_memory)),
          identity(welcome.identity),
          reader(*memory, memory.slot()) {}

    ClientMemory memory;
    std::uint64_t identity;
    LogReader reader;
  };

  void finish_log();
  [[nodiscard]] bool wants(const Carried& carried) const;
  void put(const Carried& carried);
  void publish();

  const std::uint64_t client_;
  std::vector<SocketCanFilter> filters_;
  std::optional<Log> log_;
  ReceiveQueue queue_{queue_limit};
  Statistics before_;  // dropped and unheard of logs before this one
};

}  // namespace roio::local

#endif
