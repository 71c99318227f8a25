#include "form/labels.hpp"

#include <roio/text.hpp>

namespace roio::cli {
namespace {

constexpr std::size_t longest_address = 6;  // "31.254"
constexpr std::size_t longest_class = 7;    // "message"

class NumericLabels final : public Labels {
 public:
  [[nodiscard]] std::string address(Address address) const override { return to_string(address); }
  [[nodiscard]] MessageLabel message(const Message& message) const override {
    return {"[" + std::to_string(message.length) + "]", "", false};
  }
  [[nodiscard]] std::uint32_t variant(const Frame& /*frame*/) const noexcept override { return 0; }
  [[nodiscard]] std::size_t address_width() const noexcept override { return longest_address; }
  [[nodiscard]] std::size_t message_width() const noexcept override { return longest_class; }
};

}  // namespace

const Labels& numeric_labels() {
  static const NumericLabels labels;
  return labels;
}

}  // namespace roio::cli
