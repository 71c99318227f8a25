/// Labels: what addresses and messages are called, by a robot's names or by numbers.
#ifndef ROIO_CLI_LABELS_HPP
#define ROIO_CLI_LABELS_HPP

#include <cstddef>
#include <cstdint>
#include <roio/address.hpp>
#include <roio/frame.hpp>
#include <roio/message.hpp>
#include <string>

namespace roio::cli {

struct MessageLabel {
  std::string name;       ///< "angles", or its length as dump shows it: "[3]".
  std::string fields;     ///< "shoulder=90 deg  elbow=45 deg".
  bool is_named = false;  ///< The fields say all of it; else its bytes are shown.
};

class Labels {
 public:
  Labels() = default;
  Labels(const Labels&) = delete;
  Labels& operator=(const Labels&) = delete;
  virtual ~Labels() = default;

  [[nodiscard]] virtual std::string address(Address address) const = 0;
  [[nodiscard]] virtual MessageLabel message(const Message& message) const = 0;
  /// Tells frames of one identifier and one length apart that are different messages, by a tag in
  /// their bytes for instance. Called for each frame; of the number the low 28 bits count.
  [[nodiscard]] virtual std::uint32_t variant(const Frame& frame) const noexcept = 0;

  /// How wide columns of them are.
  [[nodiscard]] virtual std::size_t address_width() const noexcept = 0;
  [[nodiscard]] virtual std::size_t message_width() const noexcept = 0;
};

/// "0.2" and "[3]": for those who have no names.
const Labels& numeric_labels();

}  // namespace roio::cli

#endif
