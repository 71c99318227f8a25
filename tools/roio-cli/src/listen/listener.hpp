/// Listens to buses until enough has come, nothing comes any more, or a signal ends it: what `dump`
/// and `record` have in common.
#ifndef ROIO_CLI_LISTENER_HPP
#define ROIO_CLI_LISTENER_HPP

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <roio/bus.hpp>
#include <roio/robot.hpp>
#include <string>
#include <vector>

#include "form/origin.hpp"
#include "form/record_format.hpp"
#include "listen/bus_watch.hpp"

namespace roio::cli {

struct ListenOptions {
  std::vector<std::string> buses;      ///< One or more, none twice.
  std::vector<std::string> filters;    ///< Addresses in them are numbers.
  std::shared_ptr<const Robot> robot;  ///< Whose names hold; null: none.
  std::optional<std::uint64_t> count;  ///< End after so many frames shown.
  std::optional<Timeout> quiet_time;   ///< End after so long without one.
  bool no_foreign = false;
  bool errors = false;
  /// How long to let frames gather before they are taken, once one has come: fewer and bigger
  /// batches, which cost less.
  Timeout gather = no_wait;
};

/// Who is told.
class Hearer {
 public:
  Hearer() = default;
  Hearer(const Hearer&) = delete;
  Hearer& operator=(const Hearer&) = delete;
  virtual ~Hearer() = default;

  virtual void frame(const Origin& from, const Received& received) = 0;
  virtual void news(const Origin& from, const BusNews& news) = 0;
  /// All that has come by now has been told; called at least five times a second.
  /// @param quiet nothing came meanwhile.
  virtual void settle(bool quiet) = 0;
};

class Listener {
 public:
  /// Opens the buses and sets the filters: from here on, frames wait to be heard.
  /// @throws UsageError, std::system_error.
  explicit Listener(const ListenOptions& options);

  /// Listens until the end.
  void run(Hearer& hearer);

  [[nodiscard]] const std::vector<Origin>& origins() const { return origins_; }
  /// Frames told of, of all buses or of one.
  [[nodiscard]] std::uint64_t frames() const;
  [[nodiscard]] std::uint64_t frames(std::size_t bus) const { return ears_[bus].frames; }
  [[nodiscard]] std::uint64_t lost() const;
  [[nodiscard]] std::uint64_t lost(std::size_t bus) const;
  /// CAN FD frames, which nobody was told of.
  [[nodiscard]] std::uint64_t fd_frames(std::size_t bus) const;

  /// After run(): says what is missing, when there is.
  /// @return the exit status.
  [[nodiscard]] int finish() const;

 private:
  using Clock = std::chrono::steady_clock;

  struct Ear {
    std::uint64_t frames = 0;
    std::uint64_t announced_lost = 0;
    std::optional<BusWatch> watch{};
  };

  void open();
  [[nodiscard]] bool has_all() const { return options_.count && frames() >= *options_.count; }
  [[nodiscard]] Timeout quiet_time_left() const;
  [[nodiscard]] bool finished() const { return has_all() || quiet_time_left() <= no_wait; }
  [[nodiscard]] std::size_t room() const;
  bool receive(class Intake& intake, Hearer& hearer);
  void drain(class Intake& intake, Hearer& hearer);
  bool hear_all(const class Intake& intake, Hearer& hearer);
  bool hear(std::size_t bus, const Received& received, Hearer& hearer);
  void look();

  const ListenOptions& options_;
  std::vector<Origin> origins_;
  std::vector<std::unique_ptr<Bus>> buses_;
  std::vector<Ear> ears_;
  Clock::time_point next_look_;  // at once: the bus may be down from the start
  Clock::time_point last_heard_;
};

}  // namespace roio::cli

#endif
