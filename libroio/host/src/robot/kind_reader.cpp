#include "robot/kind_reader.hpp"

#include <filesystem>

#include "robot/at.hpp"
#include "robot/document.hpp"
#include "robot/field_reader.hpp"
#include "robot/file.hpp"
#include "robot/limits.hpp"
#include "robot/name.hpp"

namespace roio::robot_file {
namespace {

/// "3", "1..8"
std::string shown_length(const MessageKind& message) {
  const std::string least = std::to_string(message.min_length);
  return message.min_length == message.max_length
             ? least
             : least + ".." + std::to_string(message.max_length);
}

void set_length(MessageKind& message, const Layout& layout) {
  message.max_length = static_cast<std::uint8_t>(layout.bytes());
  message.min_length = message.max_length;
  if (!message.fields.empty() && message.fields.back().form == Field::Form::bytes) {
    const Field& rest = message.fields.back();
    message.min_length = static_cast<std::uint8_t>(
        message.max_length - static_cast<unsigned>(rest.maximum - rest.minimum));
  }
}

/// What the file says must be what the fields say.
void check_length(const At& at, const MessageKind& message) {
  const std::uint64_t length = at.whole(0, max_data_length);
  if (length != message.min_length || length != message.max_length) {
    at.wrong(std::to_string(length) + ", but the fields make " + shown_length(message));
  }
}

MessageKind read_message(const At& at) {
  if (!is_name(at.name())) {
    at.wrong(std::string("not a name; expected ") + name_rule);
  }
  const Object object(at, {"description", "fields", "tag", "length"});
  MessageKind message;
  message.name = at.name();
  message.description = object.line("description", 0, max_description);
  if (const auto tag = object.find("tag")) {
    message.tag = static_cast<std::uint8_t>(tag->whole(0, 255));
  }
  Layout layout(message.tag ? 8 : 0);
  if (const auto fields = object.find("fields")) {
    message.fields = read_message_fields(*fields, layout);
  }
  set_length(message, layout);
  if (const auto length = object.find("length")) {
    check_length(*length, message);
  }
  return message;
}

bool are_alike(const MessageKind& a, const MessageKind& b) {
  const bool share_a_length = a.min_length <= b.max_length && b.min_length <= a.max_length;
  return share_a_length && (!a.tag || !b.tag || a.tag == b.tag);
}

std::string shown_tags(const MessageKind& a, const MessageKind& b) {
  if (a.tag && b.tag) {
    return "tag " + std::to_string(*a.tag);
  }
  return a.tag || b.tag ? "one of them has no tag" : "neither has a tag";
}

void refuse_alike(const At& at, const MessageKind& message, const MessageKind& other) {
  const std::string own = shown_length(message);
  const std::string others = shown_length(other);
  at.wrong("cannot be told from " + quote(other.name) + ": both have length " + own +
           (others == own ? "" : " and " + others) + ", and " + shown_tags(message, other) +
           "; expected another length, or tags that differ");
}

std::vector<MessageKind> read_messages(const Object& kind, std::string_view direction) {
  std::vector<MessageKind> messages;
  const auto at = kind.find(direction);
  if (!at) {
    return messages;
  }
  if (!at->is(Value::Type::object)) {
    at->refuse("an object, name to message");
  }
  for (const At& place : at->children()) {
    MessageKind message = read_message(place);
    for (const MessageKind& other : messages) {
      if (are_alike(message, other)) {
        refuse_alike(place, message, other);
      }
    }
    messages.push_back(std::move(message));
  }
  return messages;
}

Parsed<Kind> read(std::string_view text, std::string_view origin,
                  const std::optional<std::string>& name) {
  try {
    return read_kind(Source(text, origin), name);
  } catch (const Refused& refused) {
    return refused.error();
  }
}

}  // namespace

Kind read_kind(const Source& source, const std::optional<std::string>& name) {
  const Value document = read_document(source);
  const Object object = file_object(
      source, document, {"$schema", "roio", "kind", "description", "hears", "says", "settings"});
  Kind kind;
  const At at = object.need("kind", name_rule);
  kind.name = at.identifier();
  if (name && kind.name != *name) {
    at.refuse(quote(*name) + ", as the file is called");
  }
  kind.description = object.line("description", 0, max_description);
  kind.heard = read_messages(object, "hears");
  kind.said = read_messages(object, "says");
  if (const auto settings = object.find("settings")) {
    kind.settings = read_settings(*settings);
  }
  return kind;
}

}  // namespace roio::robot_file

namespace roio {

Parsed<Kind> parse_kind(std::string_view text, std::string_view origin) {
  return robot_file::read(text, origin, std::nullopt);
}

Parsed<Kind> load_kind(const std::filesystem::path& file) {
  const std::string origin = file.string();
  const std::string name = file.filename().string();
  const std::string suffix = robot_file::kind_suffix;
  if (!name.ends_with(suffix) || name.size() == suffix.size()) {
    return ParseError{
        robot_file::shown_name(origin) + ": not called as a kind's file is; expected NAME" + suffix,
        0};
  }
  const Parsed<std::string> text = robot_file::read_file(file);
  if (!text) {
    return text.error();
  }
  return robot_file::read(*text, origin, name.substr(0, name.size() - suffix.size()));
}

}  // namespace roio
