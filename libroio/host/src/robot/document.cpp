#include "robot/document.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "robot/counting.hpp"
#include "robot/limits.hpp"
#include "robot/name.hpp"
#include "robot/syntax.hpp"

namespace roio::robot_file {
namespace {

constexpr std::string_view of_a_number = "0123456789+-.eE";

bool is_of_a_number(char character) {
  return of_a_number.find(character) != std::string_view::npos;
}

/// Builds the document from the events of nlohmann's parser (SAX). The parser tells no places; how
/// much of the text it has taken does. Each event returns whether to go on, and this one always
/// does: who stops throws.
class Builder final : public nlohmann::json_sax<nlohmann::json> {
 public:
  Builder(const Source& source, const std::size_t& taken) : source_(source), taken_(taken) {}

  Value take() { return std::move(root_); }

  bool null() override { return add(Value::Type::null, "null", taken_ - 4); }
  bool boolean(bool value) override {
    const std::string text = value ? "true" : "false";
    return add(Value::Type::boolean, text, taken_ - text.size());
  }
  bool number_integer(number_integer_t /*value*/) override { return number(); }
  bool number_unsigned(number_unsigned_t /*value*/) override { return number(); }
  bool number_float(number_float_t /*value*/, const string_t& /*text*/) override {
    return number();
  }
  bool string(string_t& value) override { return add(Value::Type::text, value, taken_ - 1); }
  bool binary(binary_t& /*value*/) override { return false; }
  bool start_object(std::size_t /*size*/) override { return open(Value::Type::object); }
  bool start_array(std::size_t /*size*/) override { return open(Value::Type::array); }
  bool key(string_t& name) override {
    key_ = name;
    key_offset_ = taken_ - 1;
    has_key_ = true;
    return true;
  }
  bool end_object() override {
    refuse_twins();
    open_.pop_back();
    return true;
  }
  bool end_array() override {
    open_.pop_back();
    return true;
  }
  bool parse_error(std::size_t position, const std::string& last_token,
                   const nlohmann::json::exception& error) override {
    const std::size_t fault = position > 0 ? position - 1 : 0;  // position counts the character
    constexpr int number_overflow = 406;
    if (error.id == number_overflow) {
      source_.refuse(fault, next_place(), quote(last_token) + " is too large a number");
    }
    const SyntaxState state{open_.empty() ? std::nullopt : std::optional(open_.back()->type),
                            has_key_, is_begun_ && open_.empty()};
    refuse_syntax(source_, fault, next_place(), state);
  }

 private:
  bool add(Value::Type type, const std::string& text, std::size_t offset) {
    Value value;
    value.type = type;
    value.text = text;
    value.offset = offset;
    put(std::move(value));
    return true;
  }

  /// As it was written: the parser's own reading is rounded, and has the locale's decimal point. It
  /// has taken what follows the number, too, unless nothing does.
  bool number() {
    const std::string_view text = source_.text();
    std::size_t end = std::min(taken_, text.size());
    while (end > 0 && !is_of_a_number(text[end - 1])) {
      --end;
    }
    std::size_t begin = end;
    while (begin > 0 && is_of_a_number(text[begin - 1])) {
      --begin;
    }
    return add(Value::Type::number, std::string(text.substr(begin, end - begin)), begin);
  }

  bool open(Value::Type type) {
    if (open_.size() == max_depth) {
      source_.refuse(taken_ - 1, next_place(),
                     "too deep; expected at most " + std::to_string(max_depth) +
                         " objects and arrays in each other");
    }
    Value value;
    value.type = type;
    value.offset = taken_ - 1;
    open_.push_back(put(std::move(value)));
    return true;
  }

  /// Where a value belongs. It stays there while it is open: what holds it does not grow meanwhile.
  Value* put(Value&& value) {
    is_begun_ = true;
    has_key_ = false;
    if (open_.empty()) {
      root_ = std::move(value);
      return &root_;
    }
    if (open_.back()->type == Value::Type::object) {
      value.name = key_;
      value.offset = key_offset_;
    }
    return &open_.back()->children.emplace_back(std::move(value));
  }

  /// Refuses an object that has a name twice. Sorted, so that a large one costs no more.
  void refuse_twins() {
    std::vector<const Value*> sorted;
    for (const Value& child : open_.back()->children) {
      sorted.push_back(&child);
    }
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const Value* a, const Value* b) { return a->name < b->name; });
    const auto twin =
        std::adjacent_find(sorted.begin(), sorted.end(),
                           [](const Value* a, const Value* b) { return a->name == b->name; });
    if (twin != sorted.end()) {
      const Value& second = **(twin + 1);
      source_.refuse(second.offset, place_in(place(), second.name), "given twice; expected once");
    }
  }

  /// Of what is open.
  [[nodiscard]] std::string place() const {
    std::string out;
    for (std::size_t i = 1; i < open_.size(); ++i) {
      if (open_[i - 1]->type == Value::Type::object) {
        out = place_in(out, open_[i]->name);
      } else {
        out += '[' + std::to_string(open_[i - 1]->children.size() - 1) + ']';
      }
    }
    return out;
  }

  /// Of the value that comes.
  [[nodiscard]] std::string next_place() const {
    if (!open_.empty() && open_.back()->type == Value::Type::array) {
      return place() + '[' + std::to_string(open_.back()->children.size()) + ']';
    }
    return has_key_ ? place_in(place(), key_) : place();
  }

  const Source& source_;
  const std::size_t& taken_;
  Value root_;
  std::vector<Value*> open_;  // the outermost first
  std::string key_;
  std::size_t key_offset_ = 0;
  bool has_key_ = false;  // whose value has not come
  bool is_begun_ = false;
};

}  // namespace

std::string place_in(std::string_view place, std::string_view name) {
  return std::string(place) + (place.empty() ? "" : ".") +
         (is_name(name, FirstCharacter::any) ? std::string(name) : quote(name));
}

Value read_document(const Source& source) {
  check_text(source);
  std::size_t taken = 0;
  Builder builder(source, taken);
  const char* begin = source.text().data();
  nlohmann::json::sax_parse(CountingIterator(begin, taken),
                            CountingIterator(begin + source.text().size(), taken), &builder);
  return builder.take();
}

}  // namespace roio::robot_file
