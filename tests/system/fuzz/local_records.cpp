#include "local/protocol.hpp"

#include <algorithm>

#include "target.hpp"

namespace roio::fuzz {
namespace {

using local::Buffer;
using local::Hello;
using local::OfferedFrame;
using local::Record;
using local::RecordType;

// What a record says, written again, must be the very bytes that it was read from.
Buffer written_again(const Record& record) {
  Buffer bytes;
  if (record.type == RecordType::frame) {
    append_record(bytes, record.as<OfferedFrame>());
  } else if (record.type == RecordType::hello) {
    append_record(bytes, record.as<Hello>());
  } else {
    local::detail::append(bytes, record.type, record.body);
  }
  return bytes;
}

}  // namespace

void check(std::string_view input) {
  std::span<const std::uint8_t> rest(reinterpret_cast<const std::uint8_t*>(input.data()),
                                     input.size());
  Record record{};
  for (;;) {
    const std::span<const std::uint8_t> before = rest;
    if (take_record(rest, record) != local::Split::record) {
      require(rest.size() == before.size(), "what is no record is left where it is");
      return;
    }
    const auto taken = before.first(before.size() - rest.size());
    require(taken.size() <= local::max_record, "no record is longer than the longest");
    const Buffer again = written_again(record);
    require(std::equal(again.begin(), again.end(), taken.begin(), taken.end()),
            "a record comes back");
    if (record.type == RecordType::frame) {
      const auto frame = from_wire(record.as<OfferedFrame>().frame);
      require(!frame || (is_valid(*frame) && frame->kind != FrameKind::error),
              "a frame let in is one that a bus carries");
    }
  }
}

}  // namespace roio::fuzz
