#include "local/protocol.hpp"

#include <random>
#include <roio/header.hpp>

namespace roio::local {
namespace {

bool size_fits(RecordType type, std::size_t size) noexcept {
  switch (type) {
    case RecordType::hello:
      return size == sizeof(Hello);
    case RecordType::frame:
      return size == sizeof(OfferedFrame);
    case RecordType::welcome:
      return size == sizeof(Welcome);
    case RecordType::refused:
      return size == sizeof(Refused);
    case RecordType::go_on:
      return size == sizeof(GoOn);
  }
  return false;
}

}  // namespace

std::uint64_t random_number() {
  std::random_device device;
  return (std::uint64_t{device()} << 32) | device() | 1U;
}

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
