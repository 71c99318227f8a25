// A C++11 consumer of roio::core: the identifier of a message.
#include <cinttypes>
#include <cstdio>
#include <roio/header.hpp>

static_assert(__cplusplus == 201103L, "the core must not ask for more than C++11");

int main() {
  const roio::Header header = {
      roio::Priority::normal, roio::MessageClass::message, {0, 2}, {0, 10}};
  uint32_t id = 0;
  if (roio::make_id(header, id) != roio::Status::ok) {
    return 1;
  }
  std::printf("%08" PRIX32 "\n", id);
}
