/// The textual forms that people type and read: addresses, data bytes, bus names. Pure functions,
/// the same in every locale. Numbers are decimal digits alone: no sign, no leading zero.
#ifndef ROIO_TEXT_HPP
#define ROIO_TEXT_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include <roio/bridge.hpp>
#include <roio/export.hpp>
#include <roio/frame.hpp>
#include <roio/header.hpp>

namespace roio {

/// Why a text was refused: one line that says what was expected and what was there.
struct ParseError {
  std::string message;
  std::size_t offset = 0;  ///< In bytes from the start of the text, where it went wrong.
};

/// A value, or why there is none.
template <typename T>
class [[nodiscard]] Parsed {
 public:
  Parsed(T value) : content_(std::move(value)) {}
  Parsed(ParseError error) : content_(std::move(error)) {}

  [[nodiscard]] bool ok() const noexcept { return std::holds_alternative<T>(content_); }
  explicit operator bool() const noexcept { return ok(); }
  [[nodiscard]] const T& value() const { return std::get<T>(content_); }
  const T& operator*() const { return value(); }
  const T* operator->() const { return &value(); }
  [[nodiscard]] const ParseError& error() const { return std::get<ParseError>(content_); }

 private:
  std::variant<T, ParseError> content_;
};

/// A text of any origin made fit for one line of an error message: in double quotes, with control
/// characters and bytes that are no UTF-8 as \xNN (\n, \r, \t, \", \\ as in C), and cut off after
/// about 48 bytes, saying how long it was.
ROIO_EXPORT std::string quote(std::string_view text);

/// Up to 8 data bytes.
struct Bytes {
  std::array<std::uint8_t, max_data_length> data{};
  std::uint8_t length = 0;
};

/// "SUBNET.NODE": "0.2", "31.254"; "0.*" and "0.255" are the broadcast address of subnet 0.
ROIO_EXPORT Parsed<Address> parse_address(std::string_view text);
/// The same, without the broadcast address: what a node may call itself.
ROIO_EXPORT Parsed<Address> parse_source(std::string_view text);
/// "0.2", or "0.*" for a broadcast.
ROIO_EXPORT std::string to_string(Address address);

/// Data bytes in hexadecimal, two digits each; between bytes a dot may stand, as cansend takes
/// them, or a space, as `roio-cli dump` prints them: "5A2D00", "5A.2D.00", "5A 2D 00". Empty text
/// is no data.
ROIO_EXPORT Parsed<Bytes> parse_hex(std::string_view text);
/// Upper-case digits, no separator.
ROIO_EXPORT std::string to_hex(const std::uint8_t* data, std::size_t length);

/// "urgent" and "normal"; "message", "system", "stream" and "reserved".
ROIO_EXPORT const char* to_string(Priority priority) noexcept;
ROIO_EXPORT const char* to_string(MessageClass message_class) noexcept;
ROIO_EXPORT Parsed<Priority> parse_priority(std::string_view text);
ROIO_EXPORT Parsed<MessageClass> parse_class(std::string_view text);

/// "normal", "listen" and "loopback".
ROIO_EXPORT Parsed<BridgeMode> parse_bridge_mode(std::string_view text);

/// What open() takes.
struct BusUrl {
  enum class Kind : std::uint8_t { socketcan, local, serial };
  Kind kind = Kind::socketcan;
  std::string target;  ///< Interface, bus name or device; "auto" is whichever has a bridge.
  std::optional<std::uint32_t>
      bitrate{};                        ///< Of a local bus or a bridge's, 1,000..1,000,000 bit/s.
  std::optional<std::uint32_t> baud{};  ///< Of a serial line, at most; bit/s.
  std::optional<BridgeMode> mode{};     ///< Of a bridge.
};
ROIO_EXPORT Parsed<BusUrl> parse_bus_url(std::string_view text);

}  // namespace roio

#endif
