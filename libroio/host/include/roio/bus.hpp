/// Bus: one CAN bus seen from a Linux program, whatever carries it.
///
///   auto bus = roio::open("can0");                        // SocketCAN
///   auto bus = roio::open("local:robot?bitrate=500000");  // between programs of one machine
///   auto bus = roio::open("serial:/dev/ttyACM0");         // a bridge: a board with an MCP2515
///
/// A local bus is carried by one of the programs on it. When that one ends another takes over,
/// which is an outage of milliseconds.
///
/// Threads: one thread may send while another receives, and any thread may call cancel(), close(),
/// state(), statistics() and take_events(). Two threads must not receive (or send) at the same
/// time.
///
/// fork(): a bus stays the parent's. In the child its calls return closed, its state is absent, and
/// nothing that it does, its end included, reaches the parent's.
///
/// In somebody else's event loop nothing has to wait: fd() tells when to call receive(), event_fd()
/// when to call take_events(), and each call that waits has a form that does not:
///
///   open()             OpenOptions::background    Events::state when it is there, or trouble()
///   send(), receive()  the timeout no_wait        Events::room; fd()
///   set_filters()      begin_set_filters()        Events::filters
///   close()            begin_close()              Events::closed
///   Bridge's requests  begin_...()                Events::reply
///   Node's constructor NodeOptions::background    Events::filters
///
/// Errors: what should not happen throws std::system_error (error.hpp); a timeout, a cancelled wait
/// and a closed bus are values.
#ifndef ROIO_BUS_HPP
#define ROIO_BUS_HPP

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>

#include <roio/export.hpp>
#include <roio/filter_socketcan.hpp>
#include <roio/frame.hpp>

namespace roio {

/// How long a call may wait. Zero: not at all. Negative counts as zero.
using Timeout = std::chrono::nanoseconds;
inline constexpr Timeout no_wait{0};
inline constexpr Timeout forever = Timeout::max();

/// Wall-clock time, as the kernel, the program that carries a local bus, or the bridge stamped it.
using Timestamp = std::chrono::sys_time<std::chrono::nanoseconds>;

enum class Result : std::uint8_t {
  ok,
  timeout,    ///< The deadline passed first; nothing was lost by it.
  cancelled,  ///< cancel() was called, before or during the wait.
  closed,     ///< close() was called, before or during the wait.
};
ROIO_EXPORT const char* to_string(Result result) noexcept;

/// How many of the frames offered went through, and why not more.
struct [[nodiscard]] Transfer {
  Result result;      ///< ok exactly when count > 0 on receive, when all went on send.
  std::size_t count;  ///< The first `count` frames went through, whatever result says.
};

struct Received {
  Frame frame;
  Timestamp time;  ///< When the frame was on the bus, by this computer's clock; a bridge's is told
                   ///< by it.
  std::uint64_t lost_before;  ///< Frames lost to this receiver between the one before and this one.
};

/// The controller's fault confinement (ISO 11898-1), and what can be wrong around it.
enum class BusState : std::uint8_t {
  active,   ///< Error-active, the normal state.
  warning,  ///< An error counter above 96.
  passive,  ///< Error-passive: a counter above 127.
  bus_off,  ///< Bus-off: the controller takes no part until it is restarted.
  down,     ///< The interface is administratively down; the bridge has no working controller.
  absent,   ///< The interface, the bridge, or who carries the local bus is gone; it is looked for.
};
ROIO_EXPORT const char* to_string(BusState state) noexcept;

/// Counted since open(). Every frame offered or due is in one of these.
struct Statistics {
  std::uint64_t sent = 0;        ///< Frames handed to the bus.
  std::uint64_t received = 0;    ///< Frames that passed the filters and were returned.
  std::uint64_t dropped = 0;     ///< Frames that passed the filters and were lost to this receiver.
  std::uint64_t send_waits = 0;  ///< Times a transmit queue was full, or a frame's turn had not
                                 ///< come (OpenOptions::in_order), and send() waited.
  std::uint64_t send_timeouts = 0;  ///< send() calls that gave up at their deadline.
  std::uint64_t error_frames = 0;   ///< Error reports of the controller.
  std::uint64_t bus_offs = 0;       ///< Times the controller went bus-off.
  std::uint64_t outages = 0;        ///< Times the bus was down or absent (BusState).
  std::uint64_t resent = 0;     ///< Frames sent again, to who took over or as a bridge missed them.
  std::uint64_t unsent = 0;     ///< Frames accepted by send() and not known to have gone when the
                                ///< bus was closed, or lost with a bridge; such that a bridge
                                ///< gave up, or cannot tell of.
  std::uint64_t unheard = 0;    ///< Frames carried on a local bus while nobody else received.
  std::uint64_t overruns = 0;   ///< Reports of a controller that it lost frames, how many unsaid.
  std::uint64_t fd_frames = 0;  ///< CAN FD frames that passed the filters of a CAN interface; they
                                ///< are counted, and not returned.
};

/// Whether this program carries a local bus for all: one of those on it does.
enum class Carry : std::uint8_t {
  if_needed,  ///< When nobody else does, at first or later.
  never,      ///< For programs that come and go. open() throws Errc::not_connected when nobody
              ///< carries it in time; the bus is absent while nobody does.
  always,     ///< For a program that is there for this. It takes the bus over from whoever has it,
              ///< and the others leave it to this one; open() throws Errc::carried_already when
              ///< there is such a program.
};

/// What has happened to a bus. Each is told once, however often it happened meanwhile.
struct Events {
  /// A send() ended before it had taken all, and there may be room since.
  bool room = false;
  /// state() or trouble() has changed, and maybe back again.
  bool state = false;
  /// Statistics::dropped, unsent or overruns has grown.
  bool loss = false;
  /// What begin_set_filters() was given last holds, or will from the moment that an absent bus is
  /// there.
  bool filters = false;
  /// Bridge::take_reply() has something.
  bool reply = false;
  /// The bus is closed, and its end will not wait for anything.
  bool closed = false;

  [[nodiscard]] bool any() const { return room || state || loss || filters || reply || closed; }
};

struct OpenOptions {
  /// Also return the controller's error reports (FrameKind::error) from receive(). They are decoded
  /// into state() and statistics() either way.
  bool error_frames = false;
  /// Receive nothing until set_filters(): for programs that only send.
  bool send_only = false;
  /// How long open() may wait for the bus (a local bus whose first program is just starting or
  /// leaving, a board that is reset when its port is opened). Zero takes a bus that is there.
  /// Whether a bridge is there shows only when it answers, so there less than a second counts as a
  /// second.
  Timeout open_timeout = std::chrono::seconds(5);
  /// open() does not wait: the bus is absent until it is there, and trouble() says what open()
  /// would have thrown, as soon as that is known; it is looked for all the same. What no waiting
  /// mends is thrown: text that names no bus, a kernel without CAN, a folder that is another
  /// user's, no descriptors or threads left.
  bool background = false;
  /// A bridge: how long a frame that send() has accepted may be on its way. It is on the bus by
  /// then (less a ninth at most), or never, whatever becomes of this program, the line and the bus
  /// meanwhile, and counted as Statistics::unsent. Less than some milliseconds is less than the
  /// line takes. A bridge gives up after 31 s at the latest, unless this is forever.
  Timeout lifetime = std::chrono::seconds(1);
  /// Of a local bus. Other kinds take no notice.
  Carry carry = Carry::if_needed;
  /// Frames go out exactly in the order in which send() is given them: an urgent one waits until
  /// all before it have gone, and passes none. For replaying what was recorded. Costs a round trip
  /// to the bus wherever the priority changes.
  bool in_order = false;
};

class ROIO_EXPORT Bus {
 public:
  Bus() = default;
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;
  virtual ~Bus() = default;

  /// Sends frames in order; waits while a queue is full, the interface is down or the controller is
  /// bus-off, to the deadline.
  /// Order among frames of one priority is kept; where the backend arbitrates, urgent ones (bit 28
  /// of an extended identifier 0) pass normal ones that still wait (but see
  /// OpenOptions::in_order). A sender does not receive its
  /// own frames.
  /// @param frames each is_valid() and not an error report, else throws Errc::bad_frame naming it
  ///        and nothing is sent.
  /// @return ok when all went; otherwise the first `count` went.
  virtual Transfer send(std::span<const Frame> frames, Timeout timeout) = 0;

  /// Takes up to frames.size() frames that have come in, in the order in which they were on the
  /// bus. Waits for the first only. An empty span returns timeout at once.
  virtual Transfer receive(std::span<Received> frames, Timeout timeout) = 0;

  [[nodiscard]] Result send(const Frame& frame, Timeout timeout = std::chrono::seconds(1)) {
    return send(std::span(&frame, 1), timeout).result;
  }
  [[nodiscard]] Result receive(Received& frame, Timeout timeout) {
    return receive(std::span(&frame, 1), timeout).result;
  }

  /// Receives from now on what any of these accepts; an empty list receives nothing. At first, all
  /// frames of all kinds are received (none with OpenOptions::send_only). Error reports are not
  /// subject to filters. Frames already queued by the old filters may still come.
  /// @throws Errc::too_many_filters: more than 512; the filters stay as they were.
  /// On a bridge this waits for its answer, a second at most.
  virtual void set_filters(std::span<const SocketCanFilter> filters) = 0;
  /// The same without waiting; Events::filters tells when they hold.
  virtual void begin_set_filters(std::span<const SocketCanFilter> filters) = 0;

  /// A file descriptor that poll() reports readable when receive() may have something; it stays the
  /// same for the life of the object. After it was readable, call receive() until it returns
  /// timeout. Owned by the bus: do not read, write or close it.
  [[nodiscard]] virtual int fd() const noexcept = 0;

  /// A file descriptor that poll() reports readable when take_events() may have something. As with
  /// fd(), it stays the same and is the bus's own. Some things come to light only in receive(), so
  /// watch both: a controller's state and losses on SocketCAN.
  [[nodiscard]] virtual int event_fd() const noexcept = 0;
  /// What has happened since it was last called, or since open() returned. Never waits; seldom
  /// there is nothing, though event_fd() was readable. Also after close(). A local bus whose
  /// carrier has been stopped tells that 200 ms after frames have begun to wait for it; while none
  /// do, only state() looks.
  virtual Events take_events() = 0;

  [[nodiscard]] virtual BusState state() const = 0;
  /// Why the bus is absent or down, as far as it is known: what open() would throw now. None: it is
  /// there, or has just gone.
  [[nodiscard]] virtual std::optional<std::system_error> trouble() const { return std::nullopt; }
  [[nodiscard]] virtual Statistics statistics() const = 0;

  /// How many others receive from this local bus, as the program that carries it last told. None:
  /// nobody can tell, as on every other kind of bus, or while another program takes over.
  [[nodiscard]] virtual std::optional<std::size_t> listeners() const { return std::nullopt; }

  /// Makes the waits of now and later return cancelled until resume(). May be called from a signal
  /// handler. A receive() that finds frames waiting, and a send() that finds room, still take them.
  virtual void cancel() noexcept = 0;
  virtual void resume() noexcept = 0;

  /// Ends the bus: hands over what send() has accepted (within a second), lets waiting calls return
  /// closed. Later calls return closed at once. Done by the destructor too; no call may be running
  /// then.
  virtual void close() noexcept = 0;
  /// The same without waiting: Events::closed tells when all is handed over and the bus has ended.
  /// Until then the destructor waits for that.
  virtual void begin_close() noexcept = 0;

  /// What open() was given, without options: "can0", "local:robot".
  [[nodiscard]] virtual const std::string& name() const noexcept = 0;
};

/// Opens a bus.
/// @param url "can0" or "socketcan:can0"; "local:NAME" or "local:NAME?bitrate=BPS", NAME of 1..64
///        letters, digits, '.', '_', '-', BPS 1000..1000000 (none: as fast as it goes);
///        "serial:DEVICE" or "serial:auto" (the one bridge that there is, see find_bridges()), with
///        "?baud=RATE" (at most; 115200, 250000, 500000, 1000000, 2000000; none: 1000000),
///        "&bitrate=BPS" and "&mode=normal|listen|loopback" (none: as the bridge has them).
/// @throws std::system_error with an Errc that says what is wrong with it and what was expected.
ROIO_EXPORT std::unique_ptr<Bus> open(std::string_view url, const OpenOptions& options = {});

}  // namespace roio

#endif
