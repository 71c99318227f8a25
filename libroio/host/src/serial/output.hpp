/// Output: records on their way to the port, in bytes. Source: docs/internals/serial-protocol.md
/// "Records".
#ifndef ROIO_SERIAL_OUTPUT_HPP
#define ROIO_SERIAL_OUTPUT_HPP

#include <cstddef>
#include <cstdint>
#include <roio/frame.hpp>
#include <roio/serial_protocol.hpp>
#include <span>
#include <vector>

namespace roio::serial {

class Output {
 public:
  [[nodiscard]] std::span<const std::uint8_t> bytes() const { return bytes_; }
  /// So many of the bytes have been sent.
  void consume(std::size_t count);
  void clear() { bytes_.clear(); }
  /// More waits than the port takes: what can wait should not be added.
  [[nodiscard]] bool is_clogged() const { return bytes_.size() >= clogged; }

  /// Whatever the bridge has heard so far is over.
  void put_delimiter();
  /// @param session the number that it asks for.
  void put_hello(std::uint32_t session);
  /// Of a session. @param sequence of the next frame down.
  void put_control(std::uint32_t session, Down operation, std::uint8_t sequence,
                   std::span<const std::uint8_t> payload);
  /// What is answered by REPLY.
  void put_numbered(std::uint32_t session, Down operation, std::uint8_t sequence,
                    std::uint8_t number, std::span<const std::uint8_t> payload);
  void put_frame(std::uint32_t session, const Frame& frame, std::uint8_t sequence,
                 std::uint8_t life);

 private:
  // As much may wait for the port; then it does not take any, and nothing is added.
  static constexpr std::size_t clogged = 1024;

  template <typename Body>
  void put(std::uint32_t session, const Body& body);

  std::vector<std::uint8_t> bytes_;
};

/// Whether the HELLO for this session has a byte that would harm a board that is still in its boot
/// loader.
bool hello_is_harmful(std::uint32_t session);

}  // namespace roio::serial

#endif
