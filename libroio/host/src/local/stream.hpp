#ifndef ROIO_LOCAL_STREAM_HPP
#define ROIO_LOCAL_STREAM_HPP

#include <cstddef>
#include <cstdint>
#include <roio/parts/fd.hpp>
#include <span>
#include <utility>

#include "local/protocol.hpp"
#include "parts/fork.hpp"

namespace roio::local {

/// A non-blocking socket with the bytes on their way in and out.
class Stream {
 public:
  explicit Stream(ParentsFd socket) : socket_(std::move(socket)) {}

  [[nodiscard]] int fd() const { return socket_.get(); }
  [[nodiscard]] bool open() const { return static_cast<bool>(socket_); }
  void close();

  enum class Read : std::uint8_t {
    some,     ///< Bytes came; there may be more.
    nothing,  ///< None just now.
    end,      ///< The other end is gone, and all that it sent has been read.
  };
  /// Reads once into the buffer that take() works on.
  Read read();
  /// Whether the last read() took as much as there is room for: then there may be more.
  [[nodiscard]] bool filled() const { return in_end_ == in_.size(); }
  /// The next record that has come in whole; its body is valid until read().
  Split take(Record& record);

  /// Where to append what is to be sent.
  [[nodiscard]] Buffer& out() { return out_; }
  [[nodiscard]] bool flushed() const { return out_start_ == out_.size(); }
  /// Sends what the socket takes. @return false: the other end is gone.
  bool flush();
  /// Bytes ever sent, and ever appended.
  [[nodiscard]] std::uint64_t sent() const { return sent_; }
  [[nodiscard]] std::uint64_t appended() const { return sent_ + (out_.size() - out_start_); }

 private:
  void compact();

  ParentsFd socket_;
  Buffer in_;  // fixed size, once used; what came and was not taken is in_start_..in_end_
  std::size_t in_start_ = 0;
  std::size_t in_end_ = 0;
  Buffer out_;  // what is not sent yet starts at out_start_
  std::size_t out_start_ = 0;
  std::uint64_t sent_ = 0;
};

/// Sends a few bytes together with a descriptor, which a socket's first record needs.
/// @return false: not possible now, or the other end is gone.
bool send_with_fd(int socket_fd, std::span<const std::uint8_t> bytes, int fd);
/// Receives up to bytes.size() bytes and, when one came along, a descriptor.
/// @return bytes received; 0 at the end or when nothing is there.
std::size_t receive_with_fd(int socket_fd, std::span<std::uint8_t> bytes, UniqueFd& fd);

}  // namespace roio::local

#endif
