#ifndef ROIO_JSON_EVENTS_HPP
#define ROIO_JSON_EVENTS_HPP

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "json/fields.hpp"

namespace roio {

/// Takes the events of nlohmann's parser (SAX) for one message, so that nothing is built that the
/// message does not hold, and an object or array where none belongs ends the reading at once: depth
/// costs no stack. Each event returns whether to go on; why not is error() or syntax_error().
class JsonEvents final : public nlohmann::json_sax<nlohmann::json> {
 public:
  [[nodiscard]] const JsonFields& fields() const { return fields_; }
  [[nodiscard]] const std::optional<ParseError>& error() const { return error_; }
  /// Where the text is no JSON, and whether that is after a whole message.
  [[nodiscard]] std::optional<std::size_t> syntax_error() const { return syntax_error_; }
  [[nodiscard]] bool is_complete() const { return place_ == Place::end; }
  /// The field that the parser was in or had just left; nothing before the first.
  [[nodiscard]] const char* last_field() const {
    return fields_.has(field_) ? rule_of(field_).name : nullptr;
  }

  bool null() override;
  bool boolean(bool value) override;
  bool number_integer(number_integer_t value) override;
  bool number_unsigned(number_unsigned_t value) override;
  bool number_float(number_float_t value, const string_t& text) override;
  bool string(string_t& value) override;
  bool binary(binary_t& value) override;
  bool start_object(std::size_t size) override;
  bool key(string_t& name) override;
  bool end_object() override;
  bool start_array(std::size_t size) override;
  bool end_array() override;
  bool parse_error(std::size_t position, const std::string& last_token,
                   const nlohmann::json::exception& error) override;

 private:
  enum class Place : std::uint8_t { start, field, data, end };

  bool fail(std::string message);
  bool refuse(const std::string& value);
  bool refuse_module(const std::string& name);
  bool begin(JsonField field);
  bool integer(std::uint64_t value, std::uint8_t max, std::uint8_t& out);
  bool data_byte(std::uint64_t value);
  bool timestamp(const std::string& number);
  bool message_class(const std::string& value);
  bool address(const Parsed<Address>& parsed, Address& out);

  JsonFields fields_;
  Place place_ = Place::start;
  JsonField field_ = JsonField::type;  // the one whose value comes, in Place::field
  std::size_t data_count_ = 0;
  std::optional<ParseError> error_;
  std::optional<std::size_t> syntax_error_;
};

}  // namespace roio

#endif
