// Sources: the pcap file format, draft-ietf-opsawg-pcap "PCAP Capture File Format"; the records,
// LINKTYPE_CAN_SOCKETCAN at tcpdump.org/linktypes.
//
// The file begins with 24 bytes; each record has 16 before the packet. All that is in the byte
// order of who writes it, which the first four bytes show. The packet's identifier is big-endian:
//
//   0          4        5       6         7          8
//   | id, tags | length | flags | reserved| raw DLC  | data ...
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstring>

#include "form/record_format.hpp"

namespace roio::cli {
namespace {

constexpr std::uint32_t magic_of_nanoseconds = 0xA1B23C4D;
constexpr std::uint16_t major_version = 2;
constexpr std::uint16_t minor_version = 4;
constexpr std::uint32_t snapshot_length = 65535;  // no packet is longer
constexpr std::uint32_t link_type_can_socketcan = 227;

constexpr std::size_t packet_header = 8;
constexpr std::int64_t ns_per_s = 1'000'000'000;

template <typename T>
void append(Buffer& out, T value) {
  std::array<char, sizeof value> bytes;
  std::memcpy(bytes.data(), &value, sizeof value);
  out.append(bytes.data(), bytes.data() + bytes.size());
}

void append_big_endian(Buffer& out, std::uint32_t value) {
  for (const unsigned shift : {24U, 16U, 8U, 0U}) {
    out.push_back(static_cast<char>(value >> shift & 0xFFU));
  }
}

class PcapFormat final : public RecordFormat {
 public:
  void begin(Buffer& out) override {
    append(out, magic_of_nanoseconds);
    append(out, major_version);
    append(out, minor_version);
    append(out, std::uint64_t{0});  // two fields that are always 0
    append(out, snapshot_length);
    append(out, link_type_can_socketcan);
  }

  void frame(Buffer& out, const Origin& /*from*/, const Received& received) override {
    const Frame& frame = received.frame;
    const std::size_t bytes = is_remote(frame.kind) ? 0 : std::min(frame.length, max_data_length);
    append_time(out, received.time);
    const auto size = static_cast<std::uint32_t>(packet_header + bytes);
    append(out, size);  // kept
    append(out, size);  // and all there was
    append_big_endian(out, tagged_id(frame.kind, frame.id));
    out.push_back(static_cast<char>(frame.length));
    out.append(std::string_view("\0\0\0", 3));  // no flags of CAN FD, no length code above 8
    out.append(frame.data, frame.data + bytes);
  }

 private:
  // Seconds have 32 bits, which end in 2106.
  static void append_time(Buffer& out, Timestamp time) {
    const std::int64_t ns = std::max<std::int64_t>(time.time_since_epoch().count(), 0);
    append(out, static_cast<std::uint32_t>(ns / ns_per_s));
    append(out, static_cast<std::uint32_t>(ns % ns_per_s));
  }
};

}  // namespace

std::unique_ptr<RecordFormat> pcap_format() {
  return std::make_unique<PcapFormat>();
}

}  // namespace roio::cli
