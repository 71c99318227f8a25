// What the core costs on this machine, in nanoseconds a call.
#include <benchmark/benchmark.h>

#include <array>
#include <cstdint>
#include <random>
#include <roio/filter.hpp>
#include <roio/filter_mcp2515.hpp>
#include <roio/frame_length.hpp>
#include <roio/message.hpp>

namespace {

/// Random identifiers, always the same, taken round and round.
class Identifiers {
 public:
  Identifiers() {
    std::mt19937 generator(1);  // NOLINT(cert-msc32-c,cert-msc51-cpp): the same in every run
    for (std::uint32_t& id : ids_) {
      id = static_cast<std::uint32_t>(generator()) & roio::id_mask;
    }
  }
  std::uint32_t next() { return ids_[position_++ % ids_.size()]; }

 private:
  std::array<std::uint32_t, 1024> ids_{};
  std::size_t position_ = 0;
};

void pack_and_unpack_header(benchmark::State& state) {
  Identifiers identifiers;
  for (auto _ : state) {  // NOLINT(clang-analyzer-deadcode.DeadStores)
    roio::Header header = roio::unpack_id(identifiers.next());
    benchmark::DoNotOptimize(header);
    std::uint32_t id = roio::pack_id(header);
    benchmark::DoNotOptimize(id);
  }
}
BENCHMARK(pack_and_unpack_header);

void match_plain_node_filter(benchmark::State& state) {
  Identifiers identifiers;
  roio::FilterProgram<8> program;
  if (compile(roio::interest_of({0, 2}), program) != roio::Status::ok) {
    state.SkipWithError("the plain node's program does not compile");
  }
  for (auto _ : state) {  // NOLINT(clang-analyzer-deadcode.DeadStores)
    bool accepted = program.accepts(identifiers.next());
    benchmark::DoNotOptimize(accepted);
  }
}
BENCHMARK(match_plain_node_filter);

void fit_plain_node_to_mcp2515(benchmark::State& state) {
  roio::FilterProgram<8> program;
  if (compile(roio::interest_of({0, 2}), program) != roio::Status::ok) {
    state.SkipWithError("the plain node's program does not compile");
  }
  for (auto _ : state) {  // NOLINT(clang-analyzer-deadcode.DeadStores)
    benchmark::DoNotOptimize(program);
    roio::Mcp2515Filters image = roio::fit_mcp2515(program);
    benchmark::DoNotOptimize(image);
  }
}
BENCHMARK(fit_plain_node_to_mcp2515);

void exact_bit_length(benchmark::State& state) {
  Identifiers identifiers;
  roio::Frame frame{0, roio::FrameKind::extended, static_cast<std::uint8_t>(state.range(0)), {}};
  for (auto _ : state) {  // NOLINT(clang-analyzer-deadcode.DeadStores)
    frame.id = identifiers.next();
    frame.data[0] = static_cast<std::uint8_t>(frame.id);
    std::uint8_t bits = roio::wire_bits(frame);
    benchmark::DoNotOptimize(bits);
  }
}
BENCHMARK(exact_bit_length)->ArgName("bytes")->Arg(0)->Arg(8);

}  // namespace
