#include "local_protocol.hpp"

#include <algorithm>

#include "target.hpp"

namespace {

using namespace roio;
using namespace roio::local;

// What a record says, written again, must be the very bytes that it was read from.
Buffer written_again(const Record& record) {
  Buffer bytes;
  if (record.type == RecordType::filters) {
    append_filters(bytes, filters_of(record));
  } else if (record.type == RecordType::frame) {
    append_record(bytes, record.as<OfferedFrame>());
  } else if (record.type == RecordType::deliver) {
    append_record(bytes, record.as<Deliver>());
  } else {
    local::detail::append(bytes, record.type, record.body);
  }
  return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::span<const std::uint8_t> rest(data, size);
  Record record{};
  for (;;) {
    const std::span<const std::uint8_t> before = rest;
    if (take_record(rest, record) != Split::record) {
      fuzz::require(rest.size() == before.size(), "what is no record is left where it is");
      return 0;
    }
    const auto taken = before.first(before.size() - rest.size());
    fuzz::require(taken.size() <= max_record, "no record is longer than the longest");
    const Buffer again = written_again(record);
    fuzz::require(std::equal(again.begin(), again.end(), taken.begin(), taken.end()),
                  "a record comes back");
    if (record.type == RecordType::frame) {
      const auto frame = from_wire(record.as<OfferedFrame>().frame);
      fuzz::require(!frame || (is_valid(*frame) && frame->kind != FrameKind::error),
                    "a frame let in is one that a bus carries");
    }
  }
}
