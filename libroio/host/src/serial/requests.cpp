#include "serial/requests.hpp"

#include <chrono>
#include <utility>

namespace roio::serial {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds bye_interval{50};
constexpr milliseconds bus_interval{300};  // the controller is started anew, which takes its time
constexpr milliseconds other_interval{100};

Time interval_of(Down operation) {
  switch (operation) {
    case Down::bye:
      return bye_interval;
    case Down::bus:
      return bus_interval;
    default:
      return other_interval;
  }
}

}  // namespace

std::optional<Requests::Question> Requests::next(Time now) {
  if (asked_ || waiting_.empty()) {
    return std::nullopt;
  }
  Request request = std::move(waiting_.front());
  waiting_.pop_front();
  return ask(std::move(request), now);
}

Requests::Question Requests::ask(Request request, Time now) {
  asked_.emplace(Asked{std::move(request), take_number(), 1, now});
  return write(now);
}

Requests::Question Requests::write(Time now) {
  asked_->repeat_at = now + interval_of(asked_->request.operation);
  return {asked_->request.operation, asked_->number, asked_->request.payload};
}

std::optional<Requests::Question> Requests::repeat(Time now) {
  if (asked_->tries == max_tries) {
    finish({Reply::Kind::unanswered, Status::ok});
    return std::nullopt;
  }
  ++asked_->tries;
  ++retries_;
  return write(now);
}

bool Requests::answer(std::uint8_t number, Status status) {
  if (!asked_ || asked_->number != number) {
    return false;
  }
  finish({Reply::Kind::answered, status});
  return true;
}

void Requests::end() {
  if (asked_) {
    finish({Reply::Kind::no_session, Status::ok});
  }
  for (const Request& request : std::exchange(waiting_, {})) {
    request.done({Reply::Kind::no_session, Status::ok});
  }
}

/// Its turn is over before it is told, so that it may ask for more.
void Requests::finish(const Reply& reply) {
  const Done done = std::move(asked_->request.done);
  asked_.reset();
  if (done) {
    done(reply);
  }
}

}  // namespace roio::serial
