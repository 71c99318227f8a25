#include "top/labels.hpp"

#include <roio/text.hpp>

namespace roio::cli {
namespace {

class NumericLabels final : public Labels {
 public:
  [[nodiscard]] std::string address(Address address) const override { return to_string(address); }
  [[nodiscard]] MessageLabel message(const Message& message) const override {
    return {"[" + std::to_string(message.length) + "]", ""};
  }
  [[nodiscard]] std::uint32_t variant(const Frame& /*frame*/) const noexcept override { return 0; }
};

}  // namespace

const Labels& numeric_labels() {
  static const NumericLabels labels;
  return labels;
}

}  // namespace roio::cli
