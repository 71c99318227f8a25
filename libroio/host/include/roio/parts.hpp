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
///   EventFlag          a flag for poll(): room in a transmit queue, work for a thread, its end
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
///       return roio::send_queued(waits_, sendable_, frames, timeout,
///           [this](auto rest) { return offer(rest); },
///           [this](bool gives_up) { count(gives_up); });
///     }
///     Transfer receive(std::span<Received> frames, Timeout timeout) override {
///       return roio::receive_queued(waits_, queue_.readable(), frames, timeout,
///           [this](auto room) { return take(room); });
///     }
///     int fd() const noexcept override { return queue_.readable().fd(); }
///     void cancel() noexcept override { waits_.cancel(); }
///     void resume() noexcept override { waits_.resume(); }
///     void close() noexcept override;
///    private:
///     void serve();
///     std::mutex mutex_;    // over queue_ and all counts; the flags need none
///     roio::ReceiveQueue queue_{16384};
///     roio::EventFlag sendable_, stop_;
///     roio::Waits waits_;
///     std::thread thread_;  // last: it uses all of the above
///   };
///
/// - offer(): under the lock: nullopt when closed, else how many it accepted. If not all, it clears
///   sendable_.
/// - take(): under the lock: nullopt when closed, else queue_.take(room).
/// - close(): waits_.close(); what was accepted goes out, a second at most; stop_.set();
///   thread_.join().
/// - serve(): polls the carrier and stop_. What has come: queue_.put(), under the lock. What has
///   gone, so that there is room: sendable_.set().
///
/// Threads. Of a bus, one thread may send while another receives, and any may call the rest. Waits,
/// EventFlag and Deadline take care of themselves; ReceiveQueue and the backend's own counts need
/// the backend's lock. No lock is held while a wait lasts: send_queued() and receive_queued() call
/// what they are given without one, and that locks by itself.
///
/// Lifetimes. The parts own their descriptors and nothing else, and none starts a thread. Waits and
/// flags must outlive all calls that wait for them: close() makes these return, and the contract
/// wants none to be running when the bus ends. A thread goes before what it uses.
///
/// Order. Set a flag after what it tells of is there, and clear it only under the lock under which
/// that is looked at; else a wait misses it. close() is Waits::close() first, so that nobody is
/// accepted any more, then what was accepted (a second at most), then the thread.
///
/// Errors. What takes descriptors (EventFlag, and with it Waits and ReceiveQueue) or a thread
/// throws std::system_error when the system has none left, and Waits::wait() when poll() fails.
/// check_sendable() throws Errc::bad_frame. Timeout, cancelled and closed are values (Result).
///
/// Nothing is lost in silence: whatever a backend drops, it counts in Statistics, and tells
/// receivers by Received::lost_before: ReceiveQueue does both for what it drops itself, and lose()
/// for what was lost before it came there.
#ifndef ROIO_PARTS_HPP
#define ROIO_PARTS_HPP

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
