// Random kinds, their header and ES module, and what these have to do: a C++11 program that checks
// the headers, and lines of JSON for check_modules.mjs. roio::pack() and roio::unpack() say what is
// right.
//
//   make_property FOLDER COUNT
#include <fmt/format.h>

#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <roio/kind.hpp>
#include <string>

#include "kind/header.hpp"
#include "kind/header_message.hpp"
#include "kind/js.hpp"
#include "kind/names.hpp"
#include "random_kind.hpp"
#include "seed.hpp"

namespace roio::test {
namespace {

using Json = nlohmann::json;
using cli::header::FieldNames;
using cli::header::MessageNames;

constexpr int vectors_a_message = 3;
constexpr int frames_a_message = 4;

std::span<const std::uint8_t> span_of(const Bytes& bytes) {
  return {bytes.data.data(), bytes.length};
}

std::string byte_list(std::span<const std::uint8_t> data) {
  std::string text;
  for (const std::uint8_t byte : data) {
    text += fmt::format("{}{}", text.empty() ? "" : ", ", byte);
  }
  return data.empty() ? "0" : text;  // C++ has no array of none
}

// --- the C++ program
// --------------------------------------------------------------------------------

std::string raw_text(const FieldNames& names, std::int64_t raw) {
  const bool is_signed = names.field->form == Field::Form::signed_number;
  const std::string number = cli::header::literal(raw, is_signed);
  return names.choice_type.empty() ? number
                                   : fmt::format("static_cast<{}>({})", names.choice_type, number);
}

/// Lines that put values into `m`, or compare them with those in `m`.
template <typename Line>
std::string each_member(const MessageNames& names, const std::vector<Reading>& readings,
                        Line line) {
  std::string text;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const FieldNames& field = names.fields[i];
    if (field.field->form != Field::Form::bytes) {
      text += line(field.member, raw_text(field, readings[i].raw));
      continue;
    }
    for (std::uint8_t byte = 0; byte < readings[i].bytes.length; ++byte) {
      text += line(fmt::format("{}[{}]", field.member, byte),
                   fmt::format("{}", readings[i].bytes.data.at(byte)));
    }
    if (!field.count_member.empty()) {
      text += line(field.count_member, fmt::format("{}", readings[i].raw));
    }
  }
  return text;
}

std::string assigned(const std::string& member, const std::string& value) {
  return fmt::format("    m.{} = {};\n", member, value);
}
std::string compared(const std::string& member, const std::string& value) {
  return fmt::format("    CHECK(m.{} == {});\n", member, value);
}

std::string check_pack(const MessageNames& names, const Bytes& packed) {
  const auto readings = unpack(*names.message, span_of(packed));
  return fmt::format(
      "  {{\n    {0} m = {0}();\n{1}    const uint8_t wanted[] = {{{2}}};\n"
      "    uint8_t bytes[9] = {{0}};\n    CHECK(pack(m, bytes));\n"
      "    CHECK(length_of(m) == {3} && same(bytes, wanted, {3}));\n  }}\n",
      names.type, each_member(names, readings, assigned), byte_list(span_of(packed)),
      packed.length);
}

/// One past the largest number, where the member can hold it.
std::string check_refusal(const MessageNames& names, const Bytes& packed) {
  std::string text;
  for (const FieldNames& field : names.fields) {
    const bool is_signed = field.field->form == Field::Form::signed_number;
    const bool is_number = is_signed || field.field->form == Field::Form::number;
    const unsigned bits = field.field->width <= 8 ? 8 : field.field->width == 16 ? 16 : 32;
    const std::int64_t holds = (std::int64_t{1} << (is_signed ? bits - 1 : bits)) - 1;
    if (!is_number || field.field->maximum >= holds) {
      continue;
    }
    text += fmt::format(
        "  {{\n    {0} m = {0}();\n{1}    m.{2} = {3};\n    uint8_t bytes[9] = {{0x5A}};\n"
        "    CHECK(!pack(m, bytes) && bytes[0] == 0x5A);\n  }}\n",
        names.type, each_member(names, unpack(*names.message, span_of(packed)), assigned),
        field.member, raw_text(field, field.field->maximum + 1));
  }
  return text;
}

bool is_right(const MessageKind& message, const Bytes& bytes) {
  if (!message.fits(span_of(bytes))) {
    return false;
  }
  const auto readings = unpack(message, span_of(bytes));
  return std::all_of(readings.begin(), readings.end(),
                     [](const Reading& reading) { return reading.is_valid(); });
}

std::string check_unpack(const MessageNames& names, const Bytes& bytes) {
  std::string text = fmt::format("  {{\n    const uint8_t bytes[] = {{{}}};\n    {} m;\n",
                                 byte_list(span_of(bytes)), names.type);
  if (!is_right(*names.message, bytes)) {
    return text + fmt::format("    CHECK(!unpack(bytes, {}, m));\n  }}\n", bytes.length);
  }
  text += fmt::format("    CHECK(unpack(Came(bytes, {}), m));\n", bytes.length);
  return text + each_member(names, unpack(*names.message, span_of(bytes)), compared) + "  }\n";
}

std::string check_facts(const MessageNames& names) {
  std::string text =
      fmt::format("  CHECK({}::length == {});\n", names.facts, names.message->max_length);
  if (names.message->tag) {
    text += fmt::format("  CHECK({}::tag == {});\n", names.facts, *names.message->tag);
  }
  for (const FieldNames& field : names.fields) {
    if (field.field->form == Field::Form::choice || field.field->form == Field::Form::bytes) {
      continue;
    }
    const std::string space = names.facts + "::" + field.member;
    text += fmt::format(
        "  CHECK({0}::minimum == {1} && {0}::maximum == {2});\n"
        "  CHECK({0}::numerator == {3} && {0}::denominator == {4});\n",
        space, raw_text(field, field.field->minimum), raw_text(field, field.field->maximum),
        field.field->scale.numerator, field.field->scale.denominator);
  }
  return text;
}

constexpr const char* program_head = R"(#include <stdio.h>
#include <string.h>
struct Came {
  Came(const uint8_t* bytes, uint8_t length) : bytes_(bytes), length_(length) {}
  const uint8_t* data() const { return bytes_; }
  uint8_t length() const { return length_; }
  const uint8_t* bytes_;
  uint8_t length_;
};
static int checks = 0;
static int failures = 0;
static bool same(const uint8_t* a, const uint8_t* b, unsigned length) {
  return memcmp(a, b, length) == 0;
}
#define CHECK(condition)                                      \
  do {                                                        \
    ++checks;                                                 \
    if (!(condition)) {                                       \
      ++failures;                                             \
      printf("line %d: %s\n", __LINE__, #condition);          \
    }                                                         \
  } while (false)
)";

// --- the lines for the modules
// ----------------------------------------------------------------------

Json hex(const Bytes& bytes) {
  return {{"hex", to_hex(bytes.data.data(), bytes.length)}};
}

Json json_of(const FieldValue& value) {
  if (const double* number = value.number()) {
    return *number;
  }
  return value.choice() != nullptr ? Json(*value.choice()) : hex(*value.bytes());
}

Json json_of(const Reading& reading) {
  if (reading.field->form == Field::Form::bytes) {
    return hex(reading.bytes);
  }
  if (reading.field->form == Field::Form::choice && reading.is_valid()) {
    return reading.text();
  }
  return reading.value();
}

// --- both
// -------------------------------------------------------------------------------------------

class Property {
 public:
  Property(const std::string& folder, std::mt19937& random)
      : folder_(folder),
        random_(random),
        program_(folder + "/check.cpp"),
        lines_(folder + "/lines") {}

  void add(const Kind& kind, const std::string& source) {
    const std::string name = cli::global_identifier(kind.name);
    std::ofstream(folder_ + '/' + name + ".h") << cli::kind_header(kind, source);
    std::ofstream(folder_ + '/' + name + ".mjs") << cli::kind_js(kind, source);
    program_ << "#include \"" << name << ".h\"\n";
    add_direction(kind, name, "heard", kind.heard);
    add_direction(kind, name, "said", kind.said);
  }

  void finish() {
    program_ << program_head << checks_ << "int main() {\n"
             << calls_
             << "  printf(\"%d checks\\n\", checks);\n  return failures == 0 ? 0 : 1;\n}\n";
  }

 private:
  void add_direction(const Kind& kind, const std::string& name, const std::string& direction,
                     const std::vector<MessageKind>& messages) {
    cli::Scope scope = cli::header::direction_scope();
    for (const MessageKind& message : messages) {
      const MessageNames names = cli::header::names_of(message, scope);
      const std::string function = fmt::format("check_{}", ++count_);
      checks_ += fmt::format("static void {}() {{\n  using namespace {}::{};\n", function, name,
                             direction);
      calls_ += fmt::format("  {}();\n", function);
      checks_ += check_facts(names);
      const Json which{{"kind", name}, {"direction", direction}, {"message", message.name}};
      for (int i = 0; i < vectors_a_message; ++i) {
        add_vector(kind, names, which);
      }
      for (int i = 0; i < frames_a_message; ++i) {
        add_frame(kind, names, which, random_bytes(random_, message));
      }
      checks_ += "}\n";
    }
  }

  void add_vector(const Kind& kind, const MessageNames& names, const Json& message) {
    Json line = message;
    const Vector vector = random_vector(random_, *names.message);
    Json values = Json::object();
    for (const NamedValue& value : vector.values) {
      values[value.name] = json_of(value.value);
    }
    line["values"] = values;
    line["packed"] = vector.packed ? hex(*vector.packed) : Json(nullptr);
    lines_ << line << '\n';
    if (vector.packed) {
      checks_ += check_pack(names, *vector.packed) + check_refusal(names, *vector.packed);
      add_frame(kind, names, message, *vector.packed);
    }
  }

  void add_frame(const Kind& kind, const MessageNames& names, Json line, const Bytes& bytes) {
    checks_ += check_unpack(names, bytes);
    line["bytes"] = hex(bytes);
    line["unpacked"] = nullptr;
    if (names.message->fits(span_of(bytes))) {
      line["unpacked"] = Json::object();
      for (const Reading& reading : unpack(*names.message, span_of(bytes))) {
        line["unpacked"][reading.field->name] = json_of(reading);
      }
    }
    const MessageKind* fitting =
        line["direction"] == "heard" ? kind.hears(span_of(bytes)) : kind.says(span_of(bytes));
    line["name"] = fitting == nullptr ? Json(nullptr) : Json(fitting->name);
    lines_ << line << '\n';
  }

  std::string folder_;
  std::mt19937& random_;
  std::ofstream program_;
  std::ofstream lines_;
  std::string checks_;
  std::string calls_;
  int count_ = 0;
};

int make(const std::string& folder, int count) {
  std::mt19937 random = seeded_generator();
  Property property(folder, random);
  for (int i = 0; i < count; ++i) {
    const std::string name = fmt::format("kind-{}", i);
    const std::string text = random_kind_text(random, name);
    const Parsed<Kind> kind = parse_kind(text, name);
    if (!kind) {
      std::cerr << kind.error().message << '\n' << text << '\n';
      return 1;
    }
    property.add(*kind, name + ".kind.json");
  }
  property.finish();
  return 0;
}

}  // namespace
}  // namespace roio::test

int main(int argc, char** argv) {
  return argc == 3 ? roio::test::make(argv[1], std::stoi(argv[2])) : 2;
}
