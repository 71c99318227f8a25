/// What a backend is made of: a class that implements roio::Bus (bus.hpp) over some carrier. Its
/// contract is bus.hpp's; docs/backend.md builds one and runs the contract suite against
/// it.
///
/// Which part for what:
///
///   check_sendable     refuses frames that no bus carries, with the error that every backend has
///   send_queued        the course of send(): offers, waits for room, ends as it should
///   receive_queued     the course of receive(): takes, waits for the first, ends as it should
///   ReceiveQueue       frames for the program: bounded, counts what finds no room, tells it with
///                      the next frame; its flag is Bus::fd()
///   Waits              cancel(), resume() and close(), and waits that they end
///   BusEvents          room to send, state, losses, close: Bus::event_fd() and take_events()
///   EventFlag          a flag for poll(): work for a thread, its end
///   UniqueFd           owns a descriptor
///   Deadline           a timeout that may be `forever`, as a point in time
///   start_thread       a thread that takes none of the program's signals
///   lane_in_driver     which frames pass which, as the MCP2515 driver has it
///   ControllerView, is_news, error_report
///                      what a controller's counters say, as a frame of FrameKind::error
///
/// A backend in short; whatever carries the frames is `carrier_` here, with a thread of its own:
///
///   class MyBus final : public roio::Bus {
///    public:
///     MyBus() : thread_(roio::start_thread([this] { serve(); })) {}
///     ~MyBus() override { close(); }
///     Transfer send(std::span<const Frame> frames, Timeout timeout) override {
///       roio::check_sendable(frames);
///       return roio::send_queued(waits_, events_, frames, timeout,
///           [this](auto rest) { return offer(rest); },
///           [this](bool gives_up) { count(gives_up); });
///     }
///     Transfer receive(std::span<Received> frames, Timeout timeout) override {
///       return roio::receive_queued(waits_, queue_.readable(), frames, timeout,
///           [this](auto room) { return take(room); });
///     }
///     int fd() const noexcept override { return queue_.readable().fd(); }
///     int event_fd() const noexcept override { return events_.fd(); }
///     Events take_events() override { return events_.take(); }
///     void cancel() noexcept override { waits_.cancel(); }
///     void resume() noexcept override { waits_.resume(); }
///     void begin_close() noexcept override { waits_.close(); work_.set(); }
///     void close() noexcept override;
///    private:
///     void serve();
///     std::mutex mutex_;    // over queue_ and all counts; the flags need none
///     roio::ReceiveQueue queue_{16384};
///     roio::BusEvents events_;
///     roio::EventFlag work_;
///     roio::Waits waits_;
///     std::thread thread_;  // last: it uses all of the above
///   };
///
/// - offer(): under the lock: nullopt when closed, else how many it accepted. If not all, it calls
///   events_.clear_room().
/// - take(): under the lock: nullopt when closed, else queue_.take(room).
/// - serve(): polls the carrier and work_. What has come: queue_.put(), under the lock. What has
///   gone, so that there is room: events_.set_room(). After each round: events_.look(), under the
///   lock. When waits_ are closed and what was accepted has gone out, or after a second, it ends,
///   with events_.tell(&Events::closed) as the last.
/// - close(): begin_close(), and joins the thread.
///
/// Threads. Of a bus, one thread may send while another receives, and any may call the rest. Waits,
/// EventFlag, BusEvents (but for look()) and Deadline take care of themselves; ReceiveQueue and the
/// backend's own counts need the backend's lock. No lock is held while a wait lasts: send_queued()
/// and receive_queued() call what they are given without one, and that locks by itself.
///
/// Lifetimes. The parts own their descriptors and nothing else, and none starts a thread. Waits and
/// flags must outlive all calls that wait for them: close() makes these return, and the contract
/// wants none to be running when the bus ends. A thread goes before what it uses.
///
/// Order. Set a flag after what it tells of is there, and clear it only under the lock under which
/// that is looked at; else a wait misses it. The end is Waits::close() first, so that nobody is
/// accepted any more, then what was accepted (a second at most), then Events::closed, then the
/// thread. Of two threads that close at once, only one may join.
///
/// Nothing waits in begin_set_filters(), begin_close(), take_events(), and in send() and receive()
/// with no_wait: other people's event loops call them.
///
/// Errors. What takes descriptors (EventFlag, and with it BusEvents, Waits and ReceiveQueue) or a
/// thread throws std::system_error when the system has none left, and Waits::wait() when poll()
/// fails. check_sendable() throws Errc::bad_frame. Timeout, cancelled and closed are values
/// (Result).
///
/// Nothing is lost in silence: whatever a backend drops, it counts in Statistics, and tells
/// receivers by Received::lost_before: ReceiveQueue does both for what it drops itself, and lose()
/// for what was lost before it came there.
#ifndef ROIO_PARTS_HPP
#define ROIO_PARTS_HPP

#include <roio/parts/bus_events.hpp>
#include <roio/parts/controller_report.hpp>
#include <roio/parts/deadline.hpp>
#include <roio/parts/fd.hpp>
#include <roio/parts/frame_check.hpp>
#include <roio/parts/lanes.hpp>
#include <roio/parts/queued_calls.hpp>
#include <roio/parts/receive_queue.hpp>
#include <roio/parts/thread.hpp>
#include <roio/parts/waits.hpp>

#endif
