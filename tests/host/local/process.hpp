#ifndef ROIO_TESTS_LOCAL_PROCESS_HPP
#define ROIO_TESTS_LOCAL_PROCESS_HPP

#include <sys/types.h>

#include <roio/parts/fd.hpp>
#include <string>
#include <vector>

namespace roio::test {

/// A local_peer of its own, whose lines can be read. Killed with the object when it still runs.
class Peer {
 public:
  explicit Peer(const std::vector<std::string>& arguments);
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;
  ~Peer();

  /// The next line it prints, without its end; "(end)" when it prints no more, "(silent)" when
  /// there is none in 60 s.
  std::string line();
  /// Tells it a line, and that it is the last.
  void tell(const std::string& line);
  void signal(int number) const;
  /// Stops it (SIGSTOP); when it returns, none of its threads runs.
  void stop() const;
  [[nodiscard]] pid_t pid() const { return pid_; }
  /// Ends it if need be, and waits for that.
  void kill();

 private:
  pid_t pid_ = -1;
  UniqueFd output_;
  UniqueFd input_;  // held open so that a peer that waits for its end goes on
  std::string buffer_;
};

/// A bus name that no other test or run uses.
std::string unique_name();

}  // namespace roio::test

#endif
