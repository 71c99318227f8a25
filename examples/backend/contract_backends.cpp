// Which buses the contract suite runs against here: this one.
#include <atomic>
#include <string>

#include "backends.hpp"
#include "memory_bus.hpp"

std::vector<roio::test::Backend> roio::test::backends() {
  return {{.name = "memory",
           .fresh =
               [] {
                 static std::atomic<int> count{0};
                 const std::string name = "memory:contract-" + std::to_string(++count);
                 return Venue{name, [wire = make_memory_wire(name)](const OpenOptions& options) {
                                return open_memory_bus(wire, options);
                              }};
               },
           .arbitrates = false,
           .paced = false,
           .one_order = true,
           .refills_fast = true,
           .there_at_once = true,
           .flood = 50'000}};
}
