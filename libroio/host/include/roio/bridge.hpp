/// Bridge: the board behind a serial: bus, as far as it is more than a bus: what it is, how it is
/// set, and what it has counted; and finding such boards.
///
///   const auto bus = roio::open("serial:/dev/ttyACM0", {.send_only = true});
///   if (roio::Bridge* const bridge = roio::bridge_of(*bus)) {
///     std::cout << to_string(bridge->info().firmware) << '\n';
///     bridge->set_bus(125'000, roio::BridgeMode::listen);
///   }
///
/// Any thread may call these, at any time before Bus::close(). Errors: std::system_error, see each.
#ifndef ROIO_BRIDGE_HPP
#define ROIO_BRIDGE_HPP

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <roio/bus.hpp>
#include <roio/export.hpp>
#include <roio/header.hpp>

namespace roio {

enum class BridgeBoard : std::uint8_t { other, uno, leonardo, mega };
/// "uno", "leonardo", "mega", as `scripts/flash` calls them; "other".
ROIO_EXPORT const char* to_string(BridgeBoard board) noexcept;

enum class BridgeMode : std::uint8_t {
  normal,
  listen,    ///< Receives and drives nothing: neither acknowledges nor sends.
  loopback,  ///< Off the bus: hears its own frames.
};
/// "normal", "listen", "loopback": as in the URL's mode=.
ROIO_EXPORT const char* to_string(BridgeMode mode) noexcept;

/// Of the bridge's controller. BusState is the same with less detail: no_controller and stuck are
/// BusState::down there.
enum class BridgeState : std::uint8_t {
  active,
  warning,
  passive,
  bus_off,
  no_controller,  ///< No MCP2515 answers the board: wiring or power.
  stuck,          ///< The controller does not get onto the bus: a wire is held at dominant.
  absent,  ///< There is no session with the bridge: what is said of it is what was last known.
};
/// "error-active", "error-warning", "error-passive", "bus-off", "no controller", "bus stuck",
/// "absent".
ROIO_EXPORT const char* to_string(BridgeState state) noexcept;

struct FirmwareVersion {
  std::uint8_t major = 0;
  std::uint8_t minor = 0;
  std::uint8_t patch = 0;
};
/// "0.1.0".
ROIO_EXPORT std::string to_string(const FirmwareVersion& version);

struct BridgeInfo {
  std::string port;  ///< "/dev/ttyACM0".
  FirmwareVersion firmware;
  BridgeBoard board = BridgeBoard::other;
  std::uint16_t osc_khz = 0;  ///< Of the controller's crystal, as measured; 0: no controller yet.
  std::uint32_t bitrate_bps = 0;       ///< As it was set.
  std::uint32_t real_bitrate_bps = 0;  ///< What the crystal makes of it, rounded down; 0: unknown.
  BridgeMode mode = BridgeMode::normal;
  std::optional<Address> address;   ///< Of the board as a node; none: it is no node.
  bool interrupt_wired = false;     ///< The controller's INT line; without it the bridge is slower.
  std::uint32_t line_rate_bps = 0;  ///< Of the serial line now.
  bool line_rate_matters = true;    ///< false: a board with USB of its own, as fast as that.
  BridgeState state = BridgeState::absent;
  std::uint8_t transmit_errors = 0;  ///< The controller's TEC.
  std::uint8_t receive_errors = 0;   ///< REC.
};

/// What the board has counted since its reset; each wraps around at 2^32.
struct BridgeCounters {
  std::uint32_t dropped = 0;         ///< Frames for the PC that found no room on the serial line.
  std::uint32_t overflows = 0;       ///< Times the controller lost frames, how many unsaid.
  std::uint32_t sent = 0;            ///< Frames sent and acknowledged on the bus.
  std::uint32_t not_sent = 0;        ///< Frames given up.
  std::uint32_t unknown = 0;         ///< Frames that the controller was restarted under.
  std::uint32_t bus_offs = 0;        ///< Times that the controller went bus-off.
  std::uint32_t message_errors = 0;  ///< Times that it found an error in a frame.
  std::uint32_t chip_losses = 0;     ///< Times that it was lost, and started anew.
  std::uint32_t discarded = 0;       ///< Frames that it gave and that were none.
  std::uint32_t damaged = 0;         ///< Records from the PC.
  std::uint32_t overruns = 0;        ///< Bytes from the PC that came too fast.
};

/// What this side has counted of the serial line since open().
struct BridgeLineCounters {
  std::uint64_t sessions = 0;  ///< That have been opened; every one but the first is an outage.
  std::uint64_t damaged = 0;   ///< Records from the bridge that were not intact, repeated by the
                               ///< line, or no sense; not what a change of line rate begins with.
  std::uint64_t lost = 0;      ///< Frames from the bridge that were due and did not come.
  std::uint64_t resent = 0;    ///< Records of frames sent again, the bridge having missed them.
  std::uint64_t retries = 0;   ///< Requests repeated for want of a reply.
  std::uint64_t failed_trials = 0;  ///< Line rates that did not stand the test.
  std::uint64_t step_downs = 0;     ///< Times that the rate was lowered for damaged records.
  std::uint64_t sent = 0;           ///< Frames to the bridge: sent and acknowledged on the bus,
  std::uint64_t not_sent = 0;       ///< given up by it,
  std::uint64_t unknown = 0;        ///< such of which nobody can tell (a session or the controller
                                    ///< was lost),
  std::uint64_t dropped = 0;        ///< and such that came to their end before the bridge had room.
                                    ///< The last three are Statistics::unsent.
  std::uint64_t unsettled = 0;      ///< Of which it is not known yet, now.
};

/// What became of a request that was begun by one of Bridge::begin_...().
struct BridgeReply {
  std::uint32_t id = 0;                    ///< Which: what begin_...() returned.
  std::optional<std::system_error> error;  ///< What the waiting form throws. None: it is done.
  std::optional<BridgeCounters> counters;  ///< Of begin_counters().
};

class ROIO_EXPORT Bridge {
 public:
  Bridge() = default;
  Bridge(const Bridge&) = delete;
  Bridge& operator=(const Bridge&) = delete;
  virtual ~Bridge() = default;

  /// As last heard, a tenth of a second ago at most; without waiting.
  [[nodiscard]] virtual BridgeInfo info() const = 0;
  /// Without waiting.
  [[nodiscard]] virtual BridgeLineCounters line_counters() const = 0;

  // NOLINTBEGIN(google-default-arguments): what overrides these has none of its own.
  // The following wait for the bridge's answer. All throw std::system_error
  //   Errc::no_bridge       it did not answer in time;
  //   Errc::bridge_refused  it answered that it cannot, and why.
  // What was set is set again when the bridge comes back after a reset or an unplugging.

  /// Asks for them.
  [[nodiscard]] virtual BridgeCounters counters(Timeout timeout = std::chrono::seconds(1)) = 0;
  /// Restarts the controller, even when both are as they were. Frames that it had to send are
  /// counted as unsent.
  /// @param bitrate_bps 1000..1000000, of the CAN bus; what the crystal allows is for the bridge to
  ///        say. 0: as it is.
  virtual void set_bus(std::uint32_t bitrate_bps, BridgeMode mode,
                       Timeout timeout = std::chrono::seconds(2)) = 0;
  /// @param address which the board answers to as a node; none: it is no node.
  virtual void set_address(std::optional<Address> address,
                           Timeout timeout = std::chrono::seconds(1)) = 0;
  /// Has the board's LED blink for so long, 0..255 s; 0 ends it. Not done again after a reset.
  virtual void identify(std::chrono::seconds duration,
                        Timeout timeout = std::chrono::seconds(1)) = 0;
  // NOLINTEND(google-default-arguments)

  // The same without waiting. Each returns a number of its own; the reply comes by take_reply(), in
  // a few seconds at most, whatever becomes of the bridge, and Events::reply tells of it.
  // All throw std::system_error std::errc::no_buffer_space when 64 are under way or not taken.

  virtual std::uint32_t begin_counters() = 0;
  virtual std::uint32_t begin_set_bus(std::uint32_t bitrate_bps, BridgeMode mode) = 0;
  virtual std::uint32_t begin_set_address(std::optional<Address> address) = 0;
  virtual std::uint32_t begin_identify(std::chrono::seconds duration) = 0;
  /// The next reply; none: there is none now.
  virtual std::optional<BridgeReply> take_reply() = 0;
};

/// The bridge behind a bus that open("serial:...") returned; null for any other kind of bus,
/// and in a child that fork() has made since. Lives as long as the bus.
ROIO_EXPORT Bridge* bridge_of(Bus& bus) noexcept;

/// A serial port where a bridge may be.
struct BridgePort {
  std::string path;                  ///< "/dev/ttyACM0".
  std::string product;               ///< What its USB device calls itself; may be empty.
  std::optional<BridgeInfo> bridge;  ///< None: why_not says why.
  std::string why_not;               ///< "held by another program", "no bridge answered"...
};

/// Looks for bridges, by HELLO on all likely ports at once. Likely are /dev/ttyACM* and
/// /dev/ttyUSB* whose USB vendor sells Arduinos or what they are made of, and that no other program
/// has open. The environment variable ROIO_SERIAL_PORTS replaces that list: paths and patterns,
/// each from / on, with a colon between them ("/dev/ttyS3:/dev/serial/by-id/*"); a colon that no
/// slash follows belongs to the name. A path that is not there is an entry, with the reason.
/// Opening an Arduino's port resets it: whatever else runs on such a board starts anew.
/// @param timeout in which a bridge must answer; an Uno's boot loader takes up to 2 s of it.
/// @return one entry for each port, in the order of their names; empty: there is none.
/// @throws Errc::relative_path: ROIO_SERIAL_PORTS has one.
ROIO_EXPORT std::vector<BridgePort> find_bridges(Timeout timeout = std::chrono::seconds(3));

}  // namespace roio

#endif
