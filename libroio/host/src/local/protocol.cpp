#include "local/protocol.hpp"

#include <roio/header.hpp>

namespace roio::local {
namespace {

bool size_fits(RecordType type, std::size_t size) noexcept {
  switch (type) {
    case RecordType::hello:
      return size == sizeof(Hello);
    case RecordType::filters:
      return size % sizeof(SocketCanFilter) == 0 && size <= max_filters * sizeof(SocketCanFilter);
    case RecordType::frame:
      return size == sizeof(OfferedFrame);
    case RecordType::consumed:
      return size == sizeof(Consumed);
    case RecordType::welcome:
      return size == sizeof(Welcome);
    case RecordType::refused:
      return size == sizeof(Refused);
    case RecordType::deliver:
      return size == sizeof(Deliver);
    case RecordType::done:
      return size == sizeof(Done);
  }
  return false;
}

}  // namespace

std::size_t lane_of(const Frame& frame) noexcept {
  const bool urgent =
      frame.kind == FrameKind::extended && unpack_id(frame.id).priority == Priority::urgent;
  return urgent ? urgent_lane : normal_lane;
}

WireFrame to_wire(const Frame& frame) noexcept {
  WireFrame wire{tagged_id(frame), frame.length, {}, {}};
  std::memcpy(wire.data.data(), frame.data, sizeof frame.data);
  return wire;
}

std::optional<Frame> from_wire(const WireFrame& wire) noexcept {
  Frame frame{
      wire.tagged_id & id_mask, static_cast<FrameKind>(wire.tagged_id >> 29), wire.length, {}};
  if (!is_valid(frame) || frame.kind == FrameKind::error) {
    return std::nullopt;
  }
  std::memcpy(frame.data, wire.data.data(), sizeof frame.data);
  return frame;
}

void detail::append(Buffer& out, RecordType type, std::span<const std::uint8_t> body) {
  const RecordHead head{static_cast<std::uint16_t>(body.size()), type, 0};
  const std::size_t start = out.size();
  out.resize(start + sizeof head + body.size());
  std::memcpy(out.data() + start, &head, sizeof head);
  if (!body.empty()) {
    std::memcpy(out.data() + start + sizeof head, body.data(), body.size());
  }
}

void append_filters(Buffer& out, std::span<const SocketCanFilter> filters) {
  Buffer body(filters.size_bytes());
  if (!filters.empty()) {
    std::memcpy(body.data(), filters.data(), filters.size_bytes());
  }
  detail::append(out, RecordType::filters, body);
}

std::vector<SocketCanFilter> filters_of(const Record& record) {
  std::vector<SocketCanFilter> filters(record.body.size() / sizeof(SocketCanFilter));
  if (!filters.empty()) {
    std::memcpy(filters.data(), record.body.data(), record.body.size());
  }
  return filters;
}

Split take_record(std::span<const std::uint8_t>& bytes, Record& record) noexcept {
  RecordHead head{};
  if (bytes.size() < sizeof head) {
    return Split::incomplete;
  }
  std::memcpy(&head, bytes.data(), sizeof head);
  if (head.zero != 0 || !size_fits(head.type, head.size)) {
    return Split::malformed;
  }
  if (bytes.size() < sizeof head + head.size) {
    return Split::incomplete;
  }
  record = Record{head.type, bytes.subspan(sizeof head, head.size)};
  bytes = bytes.subspan(sizeof head + head.size);
  return Split::record;
}

}  // namespace roio::local
