#include "ask/ask.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <roio/bus.hpp>
#include <roio/text.hpp>
#include <span>

#include "ask/answer.hpp"
#include "form/record_format.hpp"
#include "names/robot_labels.hpp"
#include "program/exit_status.hpp"
#include "program/interrupt.hpp"
#include "program/output.hpp"
#include "send/outcome.hpp"

namespace roio::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t batch_size = 32;

// @return false when a signal came first.
bool send_question(const AskOptions& options, Bus& bus) {
  Frame frame{};
  if (to_frame(options.message, frame) != Status::ok) {
    throw UsageError("not a message that can be sent");  // the words allow none such
  }
  const Result result = bus.send(frame, options.timeout);
  if (result == Result::timeout) {
    throw Failure(why_not_sent(bus, options.timeout, 0));
  }
  return result == Result::ok;
}

// What looks like an answer is none to a question that never went out. A bridge may hand on what it
// received before it tells that it has sent: then that is waited for.
bool is_sent(Bus& bus) {
  wait_for_outcomes(bus);
  return !has_given_up(bus);
}

std::optional<Received> wait_for_answer(const AskOptions& options, Bus& bus, Timestamp asked,
                                        Clock::time_point end) {
  std::array<Received, batch_size> batch;
  for (;;) {
    const Transfer transfer = bus.receive(batch, std::max<Timeout>(end - Clock::now(), no_wait));
    for (const Received& received : std::span(batch).first(transfer.count)) {
      if (is_answer(received, options.message, asked)) {
        return is_sent(bus) && Interrupt::signal() == 0 ? std::optional(received) : std::nullopt;
      }
    }
    if (transfer.count == 0 || Interrupt::signal() != 0) {
      return std::nullopt;
    }
  }
}

int no_answer(const AskOptions& options, Bus& bus) {
  const bool sent = is_sent(bus);
  if (const int signal = Interrupt::signal()) {
    return exit_signal + signal;
  }
  if (!sent) {
    throw Failure(why_not_sent(bus, options.timeout, 0));
  }
  const Address asked = options.message.header.destination;
  note(bus.name() + ": no answer from " + labels_of(options.robot)->address(asked) + " within " +
       std::to_string(options.timeout.count()) + " ms" +
       (bus.statistics().unheard > 0 ? ": nobody else is on the bus" : ""));
  return exit_failure;
}

std::unique_ptr<RecordFormat> make_format(const AskOptions& options) {
  if (options.json) {
    return json_format(false, options.robot);
  }
  TextStyle style;
  style.colour = wants_colour() ? Colour::kinds : Colour::none;
  style.labels = labels_of(options.robot);
  return text_format(style);
}

}  // namespace

int ask(const AskOptions& options) {
  const auto format = make_format(options);
  OpenOptions open_options;
  open_options.send_only = true;  // nothing comes in before the filters are set
  open_options.lifetime = options.timeout;
  const auto bus = open_until_signal(options.bus, open_options);
  bus->set_filters(answer_filters(options.message));
  const CancelOnSignal cancel_on_signal(*bus);
  const Timestamp asked = std::chrono::system_clock::now();
  const Clock::time_point end = Clock::now() + options.timeout;
  const bool sent = send_question(options, *bus);
  const auto answer = sent ? wait_for_answer(options, *bus, asked, end) : std::nullopt;
  if (!answer) {
    return no_answer(options, *bus);
  }
  Buffer out;
  format->frame(out, origins_of(std::span(&options.bus, 1)).front(), *answer);
  flush(out);
  return exit_success;
}

}  // namespace roio::cli
