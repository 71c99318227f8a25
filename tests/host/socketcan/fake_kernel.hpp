/// A kernel with CAN for tests that need no CAN: the program's own socket(), bind(), ioctl() and so
/// on act on made-up interfaces, each raw CAN socket being one end of a Unix datagram pair. For
/// what the lab cannot do: the sanitizers whose memory layout user-mode Linux has no room for, and
/// errors injected at a chosen moment. What it does not model: filters, own frames, drops.
#ifndef ROIO_TESTS_FAKE_KERNEL_HPP
#define ROIO_TESTS_FAKE_KERNEL_HPP

#include <linux/can.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace roio {

struct FakeInterface {
  int index = 1;
  bool is_can = true;
  bool up = true;
  bool carrier = true;
};

/// What the next sendmmsg() or recvmmsg() of a CAN socket does.
struct FakeAnswer {
  int error = 0;  ///< This errno; 0: as many frames as `at_most`.
  unsigned at_most = 1;
};

class FakeKernel {
 public:
  /// The one that the program's system calls go to, until the next one is made.
  FakeKernel();
  ~FakeKernel();
  FakeKernel(const FakeKernel&) = delete;
  FakeKernel& operator=(const FakeKernel&) = delete;

  /// Adds or changes an interface, and announces it.
  void set_interface(const std::string& name, const FakeInterface& interface);
  /// Deletes it: sockets bound to it are bound to nothing.
  void remove_interface(const std::string& name);
  /// socket(PF_CAN) fails with this errno; 0: it works.
  void refuse_sockets(int error);
  void answer_sends_with(const std::vector<FakeAnswer>& answers);
  void answer_receives_with(const std::vector<FakeAnswer>& answers);
  /// What the kernel's 32-bit drop counter says.
  void set_drops(std::uint32_t drops);

  /// Puts frames on the bus for the socket made last; waits while its queue is full.
  void put(const can_frame& frame) { put_bytes(&frame, sizeof frame); }
  /// A CAN FD frame, for a socket that has asked for them: to others the kernel gives none.
  void put(const canfd_frame& frame);
  /// The next frame that the socket made last has sent; none within 20 s ends the program.
  can_frame get();

  // For the system calls below.
  struct Socket {
    int wire = -1;      // the other end
    bool news = false;  // of interfaces, not CAN
    int bound = 0;      // interface index
    bool takes_fd = false;
  };
  static FakeKernel* current();
  int open_socket(bool news);
  bool owns(int fd);
  void bind(int fd, int index);
  void take_fd_frames(int fd);
  int bound(int fd);
  std::optional<FakeInterface> find(const std::string& name);
  /// What the answers given say, or the state of the interface that the socket is bound to.
  std::optional<FakeAnswer> next_send(int fd);
  std::optional<FakeAnswer> next_receive();
  std::uint32_t drops();

 private:
  void announce();
  int last_wire();
  void put_bytes(const void* frame, std::size_t size);

  std::mutex mutex_;
  std::map<int, Socket> sockets_;
  std::map<std::string, FakeInterface> interfaces_;
  std::deque<FakeAnswer> sends_;
  std::deque<FakeAnswer> receives_;
  std::uint32_t drops_ = 0;
  int refusal_ = 0;
  int last_ = -1;
};

}  // namespace roio

#endif
