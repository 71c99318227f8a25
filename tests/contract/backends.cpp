#include "backends.hpp"

#include <unistd.h>

#include <atomic>
#include <cstdlib>

namespace roio::test {
namespace {

std::string fresh_local_name() {
  static std::atomic<int> count{0};
  return "local:contract-" + std::to_string(::getpid()) + "-" + std::to_string(++count);
}

}  // namespace

std::vector<Backend> backends() {
  std::vector<Backend> all;
  all.push_back({.name = "local",
                 .fresh_url = fresh_local_name,
                 .arbitrates = false,
                 .paced = false,
                 .one_order = true,
                 .flood = 80'000});
  all.push_back({.name = "local_500k",
                 .fresh_url = [] { return fresh_local_name() + "?bitrate=500000"; },
                 .arbitrates = true,
                 .paced = true,
                 .one_order = true,
                 .flood = 3'000});
  if (const char* const interface_name = std::getenv("ROIO_TEST_CAN")) {
    all.push_back({.name = "socketcan",
                   .fresh_url = [name = std::string(interface_name)] { return name; },
                   .arbitrates = false,
                   .paced = false,
                   .one_order = false,
                   .flood = 250'000});
  }
  return all;
}

std::vector<Backend> backends_where(bool Backend::*trait) {
  std::vector<Backend> chosen = backends();
  std::erase_if(chosen, [trait](const Backend& backend) { return !(backend.*trait); });
  return chosen;
}

}  // namespace roio::test
