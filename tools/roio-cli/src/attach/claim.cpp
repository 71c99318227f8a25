#include "attach/claim.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <roio/bridge.hpp>
#include <roio/text.hpp>
#include <system_error>
#include <vector>

#include "attach/rings.hpp"
#include "program/exit_status.hpp"

namespace roio::cli {
namespace {

/// With no link in it, as far as that can be told.
std::string true_path(const std::filesystem::path& path) {
  std::error_code error;
  const auto canonical = std::filesystem::weakly_canonical(path, error);
  return error ? path.string() : canonical.string();
}

/// In which local buses live. Source: man roio-cli, ROIO_RUNTIME_DIR.
std::string folder_of_local_buses() {
  const char* const told = std::getenv("ROIO_RUNTIME_DIR");
  if (told != nullptr && *told != '\0') {
    return true_path(told);
  }
  const std::string user = std::to_string(::getuid());
  const std::filesystem::path run = "/run/user/" + user;
  std::error_code error;
  if (std::filesystem::is_directory(run, error)) {
    return true_path(run / "roio");
  }
  return true_path("/tmp/roio-" + user);
}

/// The joints of all programs, this one's among them. None where the system does not tell.
std::vector<Joint> joints_there_are() {
  std::ifstream file("/proc/net/unix");
  const std::string text(std::istreambuf_iterator<char>(file), {});
  return joints_in(text);
}

bool is_same(const Joint& a, const Joint& b) {
  return name_of(a) == name_of(b);
}

std::string joined_already(const std::string& what) {
  return what + ": joined already by another roio-cli attach; frames would go round for ever";
}

}  // namespace

std::string full_name(Bus& bus, const std::string& url) {
  const BusUrl parsed = *parse_bus_url(url);
  switch (parsed.kind) {
    case BusUrl::Kind::local:
      return "local:" + folder_of_local_buses() + "/" + parsed.target;
    case BusUrl::Kind::serial:
      if (const Bridge* const bridge = bridge_of(bus)) {
        return "serial:" + true_path(bridge->info().port);
      }
      break;
    case BusUrl::Kind::socketcan:
      break;
  }
  return "can:" + parsed.target;
}

Claim::Claim(const std::string& name, const std::string& taken)
    : socket_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  // An abstract name: it goes with the program, however that ends.
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (name.size() + 1 > sizeof(address.sun_path)) {
    throw std::system_error(ENAMETOOLONG, std::generic_category(), name);
  }
  std::memcpy(&address.sun_path[1], name.data(), name.size());
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  if (::bind(socket_, reinterpret_cast<const sockaddr*>(&address), length) != 0) {
    const int error = errno;
    ::close(socket_);
    if (error == EADDRINUSE) {
      throw Failure(taken);
    }
    throw std::system_error(error, std::generic_category(), name);
  }
}

Claim::~Claim() {
  ::close(socket_);
}

// First the claim, then the look around: of two programs that begin at once, one at least sees the
// other.
JointClaim::JointClaim(const std::string& first_name, const std::string& second_name,
                       const std::string& what)
    : claim_(name_of({number_of(first_name), number_of(second_name)}), joined_already(what)) {
  const Joint own{number_of(first_name), number_of(second_name)};
  std::vector<Joint> others;
  for (const Joint& joint : joints_there_are()) {
    if (!is_same(joint, own)) {
      others.push_back(joint);
    }
  }
  if (closes_ring(others, own)) {
    throw Failure(what +
                  ": joined already, by way of other buses that roio-cli attach joins; "
                  "frames would go round for ever");
  }
}

}  // namespace roio::cli
