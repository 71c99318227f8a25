#include "parts/fork.hpp"

#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <utility>
#include <vector>

namespace roio {
namespace {

// How often this process is a child of one that had buses; and what its parent keeps for itself.
class Forks {
 public:
  // Never destroyed: buses of a program's own static objects may end after it.
  static Forks& instance() {
    // NOLINTNEXTLINE(cppcoreguidelines-owning-memory,cppcoreguidelines-avoid-non-const-global-variables)
    static auto* const forks = new Forks;
    return *forks;
  }

  std::mutex& mutex() { return mutex_; }
  // Under a NoFork.
  void add(int fd) { fds_.push_back(fd); }
  void remove(int fd) {
    if (const auto found = std::find(fds_.begin(), fds_.end(), fd); found != fds_.end()) {
      fds_.erase(found);
    }
  }
  [[nodiscard]] unsigned count() const { return count_.load(std::memory_order_relaxed); }

 private:
  Forks() {
    // No memory for handlers: then fork() does what it always did.
    static_cast<void>(::pthread_atfork([] { instance().mutex_.lock(); },
                                       [] { instance().mutex_.unlock(); },
                                       [] { instance().begin_child(); }));
  }

  // In the child only this thread is left: what it may do is little more than close().
  void begin_child() {
    for (const int fd : fds_) {
      ::close(fd);
    }
    fds_.clear();
    count_.fetch_add(1, std::memory_order_relaxed);
    mutex_.unlock();
  }

  std::mutex mutex_;
  std::vector<int> fds_;
  std::atomic<unsigned> count_{0};
};

class ParentsBus final : public Bus {
 public:
  explicit ParentsBus(std::unique_ptr<Bus> bus)
      : bus_(std::move(bus)),
        forks_(Forks::instance().count()),
        name_(bus_->name()),
        fd_(bus_->fd()),
        event_fd_(bus_->event_fd()) {}
  ParentsBus(const ParentsBus&) = delete;
  ParentsBus& operator=(const ParentsBus&) = delete;
  ~ParentsBus() override {
    if (!is_ours()) {
      // Its end would wait for threads that are not here, and speak with the parent's sockets.
      static_cast<void>(bus_.release());
    }
  }

  using Bus::receive;
  using Bus::send;
  Transfer send(std::span<const Frame> frames, Timeout timeout) override {
    return is_ours() ? bus_->send(frames, timeout) : Transfer{Result::closed, 0};
  }
  Transfer receive(std::span<Received> frames, Timeout timeout) override {
    return is_ours() ? bus_->receive(frames, timeout) : Transfer{Result::closed, 0};
  }
  void set_filters(std::span<const SocketCanFilter> filters) override {
    if (is_ours()) {
      bus_->set_filters(filters);
    }
  }
  void begin_set_filters(std::span<const SocketCanFilter> filters) override {
    if (is_ours()) {
      bus_->begin_set_filters(filters);
    }
  }
  [[nodiscard]] int fd() const noexcept override { return fd_; }
  [[nodiscard]] int event_fd() const noexcept override { return event_fd_; }
  Events take_events() override { return is_ours() ? bus_->take_events() : Events{}; }
  [[nodiscard]] BusState state() const override {
    return is_ours() ? bus_->state() : BusState::absent;
  }
  [[nodiscard]] std::optional<std::system_error> trouble() const override {
    return is_ours() ? bus_->trouble() : std::nullopt;
  }
  [[nodiscard]] Statistics statistics() const override {
    return is_ours() ? bus_->statistics() : Statistics{};
  }
  [[nodiscard]] std::optional<std::size_t> listeners() const override {
    return is_ours() ? bus_->listeners() : std::nullopt;
  }
  void cancel() noexcept override {
    if (is_ours()) {
      bus_->cancel();
    }
  }
  void resume() noexcept override {
    if (is_ours()) {
      bus_->resume();
    }
  }
  void close() noexcept override {
    if (is_ours()) {
      bus_->close();
    }
  }
  void begin_close() noexcept override {
    if (is_ours()) {
      bus_->begin_close();
    }
  }
  [[nodiscard]] const std::string& name() const noexcept override { return name_; }

  [[nodiscard]] bool is_ours() const noexcept { return Forks::instance().count() == forks_; }
  [[nodiscard]] Bus& inner() const noexcept { return *bus_; }

 private:
  std::unique_ptr<Bus> bus_;
  const unsigned forks_;
  const std::string name_;
  const int fd_;
  const int event_fd_;
};

}  // namespace

NoFork::NoFork() {
  Forks::instance().mutex().lock();
}

NoFork::~NoFork() {
  Forks::instance().mutex().unlock();
}

ParentsFd::ParentsFd(const NoFork& /*holds the mutex*/, UniqueFd fd) : fd_(std::move(fd)) {
  if (fd_) {
    Forks::instance().add(fd_.get());
  }
}

ParentsFd& ParentsFd::operator=(ParentsFd&& other) noexcept {
  if (this != &other) {
    reset();
    fd_ = std::move(other.fd_);
  }
  return *this;
}

void ParentsFd::reset() noexcept {
  if (fd_) {
    const NoFork no_fork;
    Forks::instance().remove(fd_.get());
    fd_.reset();
  }
}

std::unique_ptr<Bus> parents_bus(std::unique_ptr<Bus> bus) {
  return std::make_unique<ParentsBus>(std::move(bus));
}

Bus* bus_itself(Bus& bus) noexcept {
  const auto* const parents = dynamic_cast<const ParentsBus*>(&bus);
  if (parents == nullptr) {
    return &bus;
  }
  return parents->is_ours() ? &parents->inner() : nullptr;
}

}  // namespace roio
