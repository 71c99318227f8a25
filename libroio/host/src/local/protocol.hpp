/// The records between a local bus's hub and its clients, over a Unix stream socket. Both ends are
/// on one machine, so numbers are in its own byte order.
///
///   head: body size (16 bits), type (8), 0 (8); then the body, a fixed struct a type.
///
///   client -> hub   hello once; then filters (nothing is delivered before), frame, consumed
///   hub -> client   welcome or refused once; then deliver, done
///
/// Frames are numbered by their sender, separately for each lane, from 1 on for the life of the
/// client, across hubs. A sender keeps a frame until the hub reports it done, and offers it again
/// to the next hub; a receiver leaves out what it has had. A hub repeats what it has carried so far
/// to clients that come over from another hub, once it knows their filters. So a hub that dies
/// loses nothing and doubles nothing.
#ifndef ROIO_LOCAL_PROTOCOL_HPP
#define ROIO_LOCAL_PROTOCOL_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <roio/filter_socketcan.hpp>
#include <roio/frame.hpp>
#include <roio/parts/lanes.hpp>
#include <span>
#include <type_traits>
#include <vector>

namespace roio::local {

inline constexpr std::uint16_t protocol_version = 2;
inline constexpr std::array<char, 4> magic = {'R', 'O', 'I', 'O'};
inline constexpr std::size_t max_filters = 512;  // as many as SocketCAN takes

/// As the hub has it, for which a remote frame is never urgent.
std::size_t lane_of(const Frame& frame) noexcept;

enum class RecordType : std::uint8_t {
  hello = 1,
  filters = 2,
  frame = 3,
  consumed = 4,
  welcome = 5,
  refused = 6,
  deliver = 7,
  done = 8,
};

struct Hello {
  static constexpr RecordType type = RecordType::hello;
  std::array<char, 4> magic;
  std::uint16_t version;
  std::uint16_t rejoining;    // 1: was on this bus under another hub
  std::uint64_t client;       // random, the same at every hub
  std::uint32_t bitrate_bps;  // 0: whatever the bus runs at
  std::uint32_t zero;
};

struct WireFrame {
  std::uint32_t tagged_id;
  std::uint8_t length;
  std::array<std::uint8_t, 3> zero;
  std::array<std::uint8_t, max_data_length> data;
};

struct OfferedFrame {
  static constexpr RecordType type = RecordType::frame;
  std::uint64_t sequence;
  WireFrame frame;
};

/// How many delivered frames the program has taken, on this connection.
struct Consumed {
  static constexpr RecordType type = RecordType::consumed;
  std::uint64_t count;
};

/// Comes with the descriptor of the client's HubCounters.
struct Welcome {
  static constexpr RecordType type = RecordType::welcome;
  std::uint32_t bitrate_bps;  // 0: as fast as it goes
  std::uint32_t window;       // frames that may wait for their done, in each lane
};

struct Refused {
  static constexpr RecordType type = RecordType::refused;
  std::uint32_t errc;
  std::uint32_t bitrate_bps;
};

struct Deliver {
  static constexpr RecordType type = RecordType::deliver;
  std::uint64_t index;  // counts what was due to this client on this connection; a gap was dropped
  std::uint64_t sender;
  std::uint64_t sequence;
  std::int64_t time_ns;  // since 1970
  WireFrame frame;
};

/// All frames up to these have left the hub.
struct Done {
  static constexpr RecordType type = RecordType::done;
  std::array<std::uint64_t, lane_count> sequence;
};

struct RecordHead {
  std::uint16_t size;
  RecordType type;
  std::uint8_t zero;
};

WireFrame to_wire(const Frame& frame) noexcept;
/// None when no bus can carry it; error reports are not carried either.
std::optional<Frame> from_wire(const WireFrame& wire) noexcept;

using Buffer = std::vector<std::uint8_t>;

namespace detail {
void append(Buffer& out, RecordType type, std::span<const std::uint8_t> body);
}

template <typename Body>
void append_record(Buffer& out, const Body& body) {
  // Every bit of the body goes over the wire, so there must be no padding in it.
  static_assert(std::has_unique_object_representations_v<Body>);
  std::array<std::uint8_t, sizeof(Body)> bytes;
  std::memcpy(bytes.data(), &body, sizeof(Body));
  detail::append(out, Body::type, bytes);
}
void append_filters(Buffer& out, std::span<const SocketCanFilter> filters);

struct Record {
  RecordType type;
  std::span<const std::uint8_t> body;  // of the size that belongs to the type

  template <typename Body>
  [[nodiscard]] Body as() const {
    Body value;
    std::memcpy(&value, body.data(), sizeof(Body));
    return value;
  }
};
std::vector<SocketCanFilter> filters_of(const Record& record);

enum class Split : std::uint8_t { record, incomplete, malformed };

/// Takes the first record off `bytes`.
/// @return record: `record` is set and bytes starts behind it; incomplete: more bytes are needed;
///         malformed: this is no record, and what follows cannot be read either.
Split take_record(std::span<const std::uint8_t>& bytes, Record& record) noexcept;

/// The longest record, head included.
inline constexpr std::size_t max_record =
    sizeof(RecordHead) + max_filters * sizeof(SocketCanFilter);
inline constexpr std::size_t deliver_size = sizeof(RecordHead) + sizeof(Deliver);

}  // namespace roio::local

#endif
