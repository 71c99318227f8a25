// A bus within one program: what one participant sends, the others receive. It shows how a backend
// is made of <roio/parts.hpp>; docs/backend.md goes through it.
#ifndef MEMORY_BUS_HPP
#define MEMORY_BUS_HPP

#include <memory>
#include <roio/bus.hpp>
#include <string>

/// What the participants have in common; it lives as long as one of them does.
struct MemoryWire;

/// @param name Bus::name() of all participants, such as "memory:robot".
std::shared_ptr<MemoryWire> make_memory_wire(std::string name);

/// One more participant. Any thread may call this.
std::unique_ptr<roio::Bus> open_memory_bus(std::shared_ptr<MemoryWire> wire,
                                           const roio::OpenOptions& options = {});

#endif
