#include "names/robot_labels.hpp"

#include <algorithm>
#include <roio/text.hpp>
#include <utility>

#include "names/fields_text.hpp"

namespace roio::cli {
namespace {

// A longer name moves its own line; the others stay in their columns.
constexpr std::size_t widest = 16;

class RobotLabels final : public Labels {
 public:
  RobotLabels(std::shared_ptr<const Robot> robot, bool bytes_only)
      : robot_(std::move(robot)),
        bytes_only_(bytes_only),
        address_width_(numeric_labels().address_width()),
        message_width_(numeric_labels().message_width()) {
    for (const Place& place : robot_->places) {
      widen(address_width_, place.name);
      if (place.kind && !bytes_only) {
        widen_by(*place.kind);
      }
    }
  }

  [[nodiscard]] std::string address(Address address) const override {
    return robot_->name_of(address);
  }

  [[nodiscard]] MessageLabel message(const Message& message) const override {
    const auto named = bytes_only_ ? std::nullopt : robot_->decode(message);
    if (!named) {
      return numeric_labels().message(message);
    }
    Buffer fields;
    append_fields(fields, *named);
    return {named->kind->name, fmt::to_string(fields), true};
  }

  // Messages of one length that a tag tells apart.
  [[nodiscard]] std::uint32_t variant(const Frame& frame) const noexcept override {
    Message message{};
    if (bytes_only_ || to_message(frame, message) != Status::ok) {
      return 0;
    }
    const MessageKind* const kind =
        robot_->meaning(message.header, std::span(message.data, message.length));
    constexpr std::uint32_t tagged = 0x100;
    return kind != nullptr && kind->tag ? tagged | *kind->tag : 0;
  }

  [[nodiscard]] std::size_t address_width() const noexcept override { return address_width_; }
  [[nodiscard]] std::size_t message_width() const noexcept override { return message_width_; }

 private:
  static void widen(std::size_t& width, const std::string& name) {
    width = std::max(width, std::min(name.size(), widest));
  }

  void widen_by(const Kind& kind) {
    for (const auto* const messages : {&kind.heard, &kind.said}) {
      for (const MessageKind& message : *messages) {
        widen(message_width_, message.name);
      }
    }
  }

  std::shared_ptr<const Robot> robot_;
  bool bytes_only_;
  std::size_t address_width_;
  std::size_t message_width_;
};

}  // namespace

std::shared_ptr<const Labels> labels_of(std::shared_ptr<const Robot> robot, bool bytes_only) {
  if (robot) {
    return std::make_shared<const RobotLabels>(std::move(robot), bytes_only);
  }
  return {std::shared_ptr<void>(), &numeric_labels()};
}

}  // namespace roio::cli
