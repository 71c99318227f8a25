#include "local/stream.hpp"

#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace roio::local {
namespace {

constexpr std::size_t kib = 1024;
constexpr std::size_t read_size = 64 * kib;
// Small enough that one buffer of the kernel does not fill the socket; large enough to save calls.
constexpr std::size_t write_size = 16 * kib;
// Sent bytes at the front of a buffer that never empties are given up from this size on.
constexpr std::size_t compact_size = 256 * kib;

}  // namespace

Stream::Read Stream::read() {
  in_.resize(max_record + read_size);
  // At most one record's beginning is left over: take() was called until nothing whole was left.
  std::copy(in_.begin() + static_cast<std::ptrdiff_t>(in_start_),
            in_.begin() + static_cast<std::ptrdiff_t>(in_end_), in_.begin());
  in_end_ -= in_start_;
  in_start_ = 0;
  const ssize_t got = ::recv(socket_.get(), in_.data() + in_end_, in_.size() - in_end_, 0);
  if (got > 0) {
    in_end_ += static_cast<std::size_t>(got);
    return Read::some;
  }
  return got < 0 && (errno == EAGAIN || errno == EINTR) ? Read::nothing : Read::end;
}

Split Stream::take(Record& record) {
  std::span<const std::uint8_t> bytes = std::span(in_).subspan(in_start_, in_end_ - in_start_);
  const Split split = take_record(bytes, record);
  in_start_ = in_end_ - bytes.size();
  return split;
}

void Stream::close() {
  // A child that was forked just now may have it, too: the other end is to know all the same.
  ::shutdown(socket_.get(), SHUT_RDWR);
  socket_.reset();
}

bool Stream::flush() {
  while (!flushed()) {
    const std::size_t size = std::min(write_size, out_.size() - out_start_);
    const ssize_t sent = ::send(socket_.get(), out_.data() + out_start_, size, MSG_NOSIGNAL);
    if (sent < 0) {
      if (errno == EINTR) {
        continue;
      }
      const bool busy = errno == EAGAIN || errno == ENOBUFS;
      compact();
      return busy;
    }
    sent_ += static_cast<std::uint64_t>(sent);
    out_start_ += static_cast<std::size_t>(sent);
  }
  out_.clear();
  out_start_ = 0;
  return true;
}

void Stream::compact() {
  if (out_start_ >= compact_size) {
    out_.erase(out_.begin(), out_.begin() + static_cast<std::ptrdiff_t>(out_start_));
    out_start_ = 0;
  }
}

bool send_with_fd(int socket_fd, std::span<const std::uint8_t> bytes, int fd) {
  iovec part{const_cast<std::uint8_t*>(bytes.data()), bytes.size()};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  cmsghdr* head = CMSG_FIRSTHDR(&message);
  head->cmsg_level = SOL_SOCKET;
  head->cmsg_type = SCM_RIGHTS;
  head->cmsg_len = CMSG_LEN(sizeof(int));
  std::memcpy(CMSG_DATA(head), &fd, sizeof fd);
  return ::sendmsg(socket_fd, &message, MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
}

std::size_t receive_with_fd(int socket_fd, std::span<std::uint8_t> bytes, UniqueFd& fd) {
  iovec part{bytes.data(), bytes.size()};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t got = ::recvmsg(socket_fd, &message, MSG_CMSG_CLOEXEC);
  if (got <= 0) {
    return 0;
  }
  for (cmsghdr* head = CMSG_FIRSTHDR(&message); head != nullptr;
       head = CMSG_NXTHDR(&message, head)) {
    if (head->cmsg_level == SOL_SOCKET && head->cmsg_type == SCM_RIGHTS) {
      int passed = -1;
      std::memcpy(&passed, CMSG_DATA(head), sizeof passed);
      fd.reset(passed);
    }
  }
  return static_cast<std::size_t>(got);
}

}  // namespace roio::local
