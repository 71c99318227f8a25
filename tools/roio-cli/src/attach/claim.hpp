/// Claim: the right to join two buses, held while it lives, so that no two programs join the same,
/// or in a ring. It is known, as an interface is, within the network namespace.
#ifndef ROIO_CLI_CLAIM_HPP
#define ROIO_CLI_CLAIM_HPP

#include <roio/bus.hpp>
#include <string>

namespace roio::cli {

/// The name of a bus that is the same whoever says it: where a local bus's folder is, which device
/// a port is.
std::string full_name(Bus& bus, const std::string& url);

/// A name that one program at a time can have.
class Claim {
 public:
  /// @param taken what to say when another program has it.
  /// @throws Failure(taken), std::system_error.
  Claim(const std::string& name, const std::string& taken);
  Claim(const Claim&) = delete;
  Claim& operator=(const Claim&) = delete;
  ~Claim();

 private:
  int socket_;
};

/// @throws Failure: they are joined already.
class JointClaim {
 public:
  JointClaim(const std::string& first_name, const std::string& second_name,
             const std::string& what);

 private:
  Claim claim_;
};

}  // namespace roio::cli

#endif
