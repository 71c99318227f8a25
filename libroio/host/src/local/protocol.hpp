/// The records between a local bus's hub and its clients, over a Unix stream socket. Both ends are
/// on one machine, so numbers are in its own byte order.
///
///   head: body size (16 bits), type (8), 0 (8); then the body, a fixed struct a type.
///
///   client -> hub   hello once; then frame, go_on
///   hub -> client   welcome or refused once, and nothing more
///
/// What a client receives it reads from the bus's memory (memory.hpp), and its filters and how far
/// it has read it writes there.
///
/// Frames are numbered by their sender, separately for each lane, from 1 on for the life of the
/// client, across hubs. A sender keeps a frame until it is in the log, and offers it again to the
/// next hub, which leaves out what is there already. So a hub that dies loses nothing and doubles
/// nothing.
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

inline constexpr std::uint16_t protocol_version = 3;
inline constexpr std::array<char, 4> magic = {'R', 'O', 'I', 'O'};
inline constexpr std::size_t max_filters = 512;  // as many as SocketCAN takes

/// As the hub has it, for which a remote frame is never urgent.
std::size_t lane_of(const Frame& frame) noexcept;

/// For a client, or a bus: nobody else has it. Not 0.
std::uint64_t random_number();

enum class RecordType : std::uint8_t {
  hello = 1,
  frame = 3,
  welcome = 5,
  refused = 6,
  go_on = 9,
};

/// Of the same size in every version, so that an old hub can say what is wrong.
struct Hello {
  static constexpr RecordType type = RecordType::hello;
  static constexpr std::uint16_t wants_the_seat = 1;
  static constexpr std::uint16_t has_the_seat = 2;  // the hub is in its process
  std::array<char, 4> magic;
  std::uint16_t version;
  std::uint16_t host;         // for a client that is there to carry the bus
  std::uint64_t client;       // random, not 0, the same at every hub
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
  std::uint32_t lane;  // lane_of(), but for senders that keep all their frames in order
  std::uint32_t zero;
  WireFrame frame;
};

/// The bus waits for this reader, which has read on since.
struct GoOn {
  static constexpr RecordType type = RecordType::go_on;
  std::uint32_t zero;
};

/// Comes with the descriptor of the flag that wakes the client.
struct Welcome {
  static constexpr RecordType type = RecordType::welcome;
  std::uint64_t identity;     // of the memory that this bus has
  std::uint32_t slot;         // the client's in it
  std::uint32_t bitrate_bps;  // 0: as fast as it goes
  std::uint32_t window;       // frames that may be on their way to the log, in each lane
  std::uint32_t fresh;        // 1: it has not had that slot before
};

struct Refused {
  static constexpr RecordType type = RecordType::refused;
  std::uint32_t errc;
  std::uint32_t bitrate_bps;
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

enum class Split : std::uint8_t { record, incomplete, malformed };

/// Takes the first record off `bytes`.
/// @return record: `record` is set and bytes starts behind it; incomplete: more bytes are needed;
///         malformed: this is no record, and what follows cannot be read either.
Split take_record(std::span<const std::uint8_t>& bytes, Record& record) noexcept;

/// The longest record, head included.
inline constexpr std::size_t max_record = sizeof(RecordHead) + sizeof(OfferedFrame);

}  // namespace roio::local

#endif
