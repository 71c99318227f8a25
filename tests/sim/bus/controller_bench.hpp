// One controller, and the wire in the test's hand: what it drives and counts, bit by bit. The cases
// of the error counters are those of ISO 16845-1 (7.6 receiver, 8.6 transmitter).
#ifndef ROIO_TESTS_CONTROLLER_BENCH_HPP
#define ROIO_TESTS_CONTROLLER_BENCH_HPP

#include <gtest/gtest.h>

#include <deque>
#include <functional>
#include <optional>
#include <roio/sim/controller.hpp>
#include <string>
#include <vector>

#include "wire_text.hpp"

namespace roio::sim {

using test::digits_of;
using test::text_of;
using test::wire_text;
using Log = std::vector<std::string>;

const Frame frame{0x1000400A, FrameKind::extended, 3, {0x5A, 0x2D, 0x00}};
const std::string frame_text = "1000400A DLC 3 5A 2D 00";
// As docs/protocol.md has it.
const std::string frame_wire = digits_of(
    "0 100000(1)00000(1) 11 000100000(1)00000(1)1010 000 0(1)011 01011010 00101101 00000(1)000 "
    "111011000010110");
// CRC delimiter, acknowledgement by somebody, its delimiter, end of frame, intermission.
const std::string acknowledged = "1 0 1 1111111 111";
const std::string integration(11, '1');
const std::string flag = "......";
const std::string delimiter = "11111111";
const std::string wrong_crc = frame_wire.substr(0, frame_wire.size() - 1) + "1";

class Owner final : public ControllerClient {
 public:
  std::deque<Frame> queue;
  Log log;
  std::function<void(const std::string&)> on_event;

  std::optional<Submission> next_submission() override {
    return queue.empty() ? std::nullopt : std::optional(Submission{queue.front(), SimTime(0)});
  }
  void on_transmitted() override {
    queue.pop_front();
    note("sent");
  }
  void on_arbitration_lost() override { note("arbitration lost"); }
  void on_transmit_error(BusError error) override {
    note(std::string("sending: ") + to_string(error));
  }
  void on_received(const Frame& received) override { note(text_of(received)); }
  void on_receive_error(BusError error) override {
    note(std::string("receiving: ") + to_string(error));
  }
  void on_confinement_changed() override {}
  void on_integrated() override { note("integrated"); }
  void on_bus_activity() override { note("activity"); }

 private:
  void note(const std::string& what) {
    log.push_back(what);
    if (on_event) {
      on_event(what);
    }
  }
};

class Bench {
 public:
  Owner owner;
  Controller controller{owner};

  explicit Bench(Controller::Mode mode = Controller::Mode::normal) {
    controller.set_mode(mode);
    run(integration);
    owner.log.clear();
  }

  /// One bit a character: 0 and 1 are the level of the wire, whatever the node drives; at a dot,
  /// the wire is as the node drives it. Everything else separates.
  /// @return what the node drove.
  std::string run(const std::string& wire) {
    std::string driven;
    for (const char c : wire) {
      if (c == '0' || c == '1' || c == '.') {
        const std::uint8_t output = controller.begin_bit();
        driven += output == dominant ? '0' : '1';
        controller.sample(c == '.' ? output : c == '0' ? dominant : recessive);
      }
    }
    return driven;
  }

  void submit(const Frame& what) {
    owner.queue.push_back(what);
    controller.request();
  }

  /// The counters, as "TEC 8, REC 0".
  [[nodiscard]] std::string counters() const {
    return "TEC " + std::to_string(controller.transmit_errors()) + ", REC " +
           std::to_string(controller.receive_errors());
  }

  /// One attempt of an active node that ends in a bit error: the last bit of the identifier, which
  /// is dominant, and its flag and delimiter and intermission.
  void fail_to_send() { run(own_bits(36) + "1 ...... 11111111 111"); }

  /// That many bits of the node's own frame, start-of-frame first, as it drives them.
  static std::string own_bits(std::size_t count) { return std::string(count, '.'); }

  void make_receive_errors(unsigned count) {
    for (unsigned i = 0; i < count; ++i) {
      // Another node's flag, seen by a node that is active or passive.
      run("000000 000000 11111111 111");
    }
  }
};

}  // namespace roio::sim

#endif
