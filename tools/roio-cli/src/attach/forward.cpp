#include "attach/forward.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>
#include <vector>

#include "form/record_format.hpp"

namespace roio::cli {
namespace {

constexpr std::size_t batch_size = 256;
constexpr Timeout receive_time = std::chrono::seconds(1);
constexpr Timeout stop_time = std::chrono::milliseconds(200);

// A frame that waits longer than this for the far side is lost: what was meant for a robot then
// must not reach it when its bridge is plugged in again an hour later.
constexpr Timeout send_time = std::chrono::seconds(1);

}  // namespace

Forwarder::Forwarder(NamedBus from, NamedBus to, Inspect inspect)
    : from_(std::move(from)),
      to_(std::move(to)),
      inspect_(std::move(inspect)),
      patience_(send_time),
      thread_([this] {
        try {
          run();
        } catch (...) {
          error_ = std::current_exception();
          failed_ = true;
        }
      }) {}

void Forwarder::stop() {
  if (thread_.joinable()) {
    stop_at_ = Clock::now() + stop_time;
    stopping_ = true;
    thread_.join();
  }
}

void Forwarder::rethrow() const {
  if (error_) {
    std::rethrow_exception(error_);
  }
}

void Forwarder::run() {
  std::vector<Received> received(batch_size);
  std::vector<Frame> frames;
  frames.reserve(batch_size);
  Result result = Result::ok;
  while (going() && (result == Result::ok || result == Result::timeout)) {
    const Transfer transfer = from_.bus.receive(received, receive_time);
    result = transfer.result;
    frames.clear();
    for (const Received& one : std::span(received).first(transfer.count)) {
      frames.push_back(one.frame);
    }
    if (inspect_) {
      inspect_(frames);
    }
    forward(frames);
  }
}

void Forwarder::forward(std::span<const Frame> frames) {
  while (!frames.empty()) {
    const Transfer transfer = to_.bus.send(frames, patience_);
    frames = frames.subspan(transfer.count);
    if (transfer.count > 0) {
      patience_ = send_time;
    } else {
      // What comes next does not wait once more for a far side that is not there.
      patience_ = no_wait;
      not_taken_ += frames.size();
      return;
    }
  }
}

std::string Forwarder::report() const {
  const Statistics near = from_.bus.statistics();
  const Statistics far = to_.bus.statistics();
  const std::array<std::pair<std::uint64_t, std::string>, 3> losses{{
      {near.dropped, " on the way from " + from_.name},
      {not_taken_, " not taken by " + to_.name},
      {far.unsent, " not sent by " + to_.name},
  }};
  std::uint64_t lost = 0;
  std::string where;
  for (const auto& [count, place] : losses) {
    lost += count;
    if (count > 0) {
      where += (where.empty() ? "" : ", ") + std::to_string(count) + place;
    }
  }
  std::string text = fmt::format("{} to {}: {}, {} lost", from_.name, to_.name,
                                 count_of(far.sent - far.unsent, "frame"), lost);
  text += where.empty() ? "" : " (" + where + ")";
  if (near.overruns > 0) {
    text += fmt::format("; the controller of {} lost others, uncounted, {}", from_.name,
                        count_of(near.overruns, "time"));
  }
  if (near.fd_frames > 0) {
    text += fmt::format("; {} of {} not handed on", count_of(near.fd_frames, "CAN FD frame"),
                        from_.name);
  }
  return text;
}

}  // namespace roio::cli
