#include <roio/kind.hpp>

namespace roio {
namespace {

const MessageKind* find(const std::vector<MessageKind>& messages, std::string_view name) noexcept {
  for (const MessageKind& message : messages) {
    if (message.name == name) {
      return &message;
    }
  }
  return nullptr;
}

const MessageKind* find(const std::vector<MessageKind>& messages,
                        std::span<const std::uint8_t> data) noexcept {
  for (const MessageKind& message : messages) {
    if (message.fits(data)) {
      return &message;
    }
  }
  return nullptr;
}

}  // namespace

const Field* MessageKind::find(std::string_view field) const noexcept {
  for (const Field& one : fields) {
    if (one.name == field) {
      return &one;
    }
  }
  return nullptr;
}

bool MessageKind::fits(std::span<const std::uint8_t> data) const noexcept {
  return data.size() >= min_length && data.size() <= max_length &&
         (!tag || (!data.empty() && data[0] == *tag));
}

const MessageKind* Kind::hears(std::string_view message) const noexcept {
  return find(heard, message);
}
const MessageKind* Kind::says(std::string_view message) const noexcept {
  return find(said, message);
}
const MessageKind* Kind::hears(std::span<const std::uint8_t> data) const noexcept {
  return find(heard, data);
}
const MessageKind* Kind::says(std::span<const std::uint8_t> data) const noexcept {
  return find(said, data);
}

}  // namespace roio
