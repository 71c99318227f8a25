// What has to be one thing on both sides of a shared library: exceptions, the category of errors,
// the types of objects; and a Bus that the program itself makes of the library's parts.
#include <chrono>
#include <iostream>
#include <roio.hpp>
#include <roio/json.hpp>
#include <roio/parts/bus_events.hpp>
#include <roio/parts/fd.hpp>
#include <roio/parts/queued_calls.hpp>
#include <roio/parts/receive_queue.hpp>
#include <roio/parts/waits.hpp>
#include <span>
#include <string>
#include <system_error>

namespace {

// Hears what it was told to.
class EchoBus final : public roio::Bus {
 public:
  roio::Transfer send(std::span<const roio::Frame> frames, roio::Timeout) override {
    for (const roio::Frame& frame : frames) {
      queue_.put(frame, {});
    }
    return {roio::Result::ok, frames.size()};
  }
  roio::Transfer receive(std::span<roio::Received> frames, roio::Timeout timeout) override {
    return roio::receive_queued(waits_, queue_.readable(), frames, timeout,
                                [&](std::span<roio::Received> out) {
                                  return std::optional<std::size_t>(queue_.take(out));
                                });
  }
  void set_filters(std::span<const roio::SocketCanFilter>) override {}
  void begin_set_filters(std::span<const roio::SocketCanFilter>) override {}
  [[nodiscard]] int fd() const noexcept override { return queue_.readable().fd(); }
  [[nodiscard]] int event_fd() const noexcept override { return events_.fd(); }
  roio::Events take_events() override { return events_.take(); }
  [[nodiscard]] roio::BusState state() const override { return roio::BusState::active; }
  [[nodiscard]] roio::Statistics statistics() const override { return {}; }
  void cancel() noexcept override { waits_.cancel(); }
  void resume() noexcept override { waits_.resume(); }
  void close() noexcept override { waits_.close(); }
  void begin_close() noexcept override { close(); }
  [[nodiscard]] const std::string& name() const noexcept override { return name_; }

 private:
  std::string name_ = "echo";
  roio::Waits waits_;
  roio::BusEvents events_;
  roio::ReceiveQueue queue_{4};
};

std::string caught() {
  try {
    static_cast<void>(roio::open("nonsense:"));
  } catch (const std::system_error& error) {
    const bool is_it =
        error.code() == roio::Errc::bad_url && &error.code().category() == &roio::error_category();
    return is_it ? "bad_url" : error.what();
  }
  return "nothing";
}

std::string heard_of_oneself() {
  roio::Node node(std::make_unique<EchoBus>(), roio::Address{0, 2});
  const std::array<std::uint8_t, 2> data = {1, 2};
  roio::ReceivedMessage message;
  if (node.send({0, 2}, data) != roio::Result::ok ||
      node.receive(message, std::chrono::seconds(5)) != roio::Result::ok) {
    return "nothing";
  }
  return roio::to_hex(message.data().data(), message.data().size());
}

}  // namespace

int main() {
  const auto bus = roio::open("local:shared");
  const roio::Bus& seen = *bus;
  std::cout << caught() << ' ' << heard_of_oneself() << ' '
            << (dynamic_cast<const EchoBus*>(&seen) == nullptr) << ' '
            << (roio::bridge_of(*bus) == nullptr) << ' '
            << roio::parse_json("{\"type\":1}").error().message << '\n';
}
