#include "random_kind.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

namespace roio::test {
namespace {

using Json = nlohmann::ordered_json;

// Keywords, macros of Arduino and of the PC, what the generated code calls its own, and names that
// are one in a language that has no '-'.
constexpr std::array names{"angle",     "default",  "switch",      "int",
                           "class",     "LOW",      "HIGH",        "PI",
                           "PORTB",     "SP",       "A0",          "EOF",
                           "stdin",     "linux",    "errno",       "SPI_STC_vect",
                           "min",       "max",      "abs",         "bit",
                           "round",     "word",     "F",           "B1",
                           "a-b",       "a_b",      "aB",          "a--b",
                           "length",    "tag",      "length_",     "minimum_length",
                           "pack",      "unpack",   "bytes",       "from",
                           "to",        "read",     "message",     "is_valid",
                           "Message",   "i",        "value",       "minimum",
                           "scale",     "toString", "constructor", "valueOf",
                           "uint8_t",   "true",     "and",         "x",
                           "X",         "heard",    "AnyMessage",  "length_of",
                           "Angle",     "data",     "data_length", "light",
                           "LightMode", "mode"};

// What ends a comment, or goes on with it, in one of the languages.
constexpr std::array descriptions{"ends with a backslash \\", "and with a space \\ ",
                                  "and a trigraph ?\?/", "*/ }"};

int below(std::mt19937& random, int end) {
  return std::uniform_int_distribution<int>(0, end - 1)(random);
}
bool chance(std::mt19937& random, int percent) {
  return below(random, 100) < percent;
}
std::int64_t between(std::mt19937& random, std::int64_t first, std::int64_t last) {
  return std::uniform_int_distribution<std::int64_t>(first, last)(random);
}

std::string new_name(std::mt19937& random, std::set<std::string>& taken) {
  for (;;) {
    std::string name = names.at(static_cast<std::size_t>(below(random, names.size())));
    if (taken.contains(name)) {
      name += std::to_string(below(random, 1000));
    }
    if (taken.insert(name).second) {
      return name;
    }
  }
}

struct Scale {
  Json written;
  double factor;  ///< 0: a multiple of it need not be a decimal number.
};

void add_scale_and_range(std::mt19937& random, Json& field, unsigned width, bool is_signed) {
  const std::array<Scale, 7> scales{Scale{1, 1}, {"1/10", 0.1}, {"1/8", 0.125},  {5, 5},
                                    {"1/3", 0},  {"22/7", 0},   {"1/1000000", 0}};
  const Scale& scale =
      scales.at(chance(random, 50) ? 0 : static_cast<std::size_t>(below(random, 7)));
  if (scale.factor != 1) {
    field["scale"] = scale.written;
  }
  if (chance(random, 40)) {
    field["unit"] = chance(random, 50) ? "deg" : "\u00b0C \"x\\";
  }
  if (scale.factor == 0 || chance(random, 50)) {
    return;
  }
  const std::int64_t lowest = is_signed ? -(std::int64_t{1} << (width - 1)) : 0;
  const std::int64_t highest = lowest + (std::int64_t{1} << width) - 1;
  const std::int64_t first = between(random, lowest, highest);
  const std::int64_t last = between(random, first, highest);
  if (chance(random, 70)) {
    field["minimum"] = static_cast<double>(first) * scale.factor;
  }
  if (chance(random, 70)) {
    field["maximum"] = static_cast<double>(last) * scale.factor;
  }
}

Json choices(std::mt19937& random, unsigned width) {
  std::vector<int> numbers(std::size_t{1} << width);
  std::iota(numbers.begin(), numbers.end(), 0);
  if (chance(random, 50)) {
    std::shuffle(numbers.begin(), numbers.end(), random);
  }
  const int count = 1 + below(random, std::min<int>(static_cast<int>(numbers.size()), 6));
  Json values = Json::object();
  std::set<std::string> taken;
  for (int i = 0; i < count; ++i) {
    const std::string name = chance(random, 20) ? std::to_string(i) : new_name(random, taken);
    values[name] = numbers[static_cast<std::size_t>(i)];
  }
  return values;
}

/// Places fields one behind the other, as the format has it, in the bits that are left.
class MessageMaker {
 public:
  MessageMaker(std::mt19937& random, bool has_tag) : random_(random), bit_(has_tag ? 8 : 0) {}

  Json fields() {
    Json all = Json::array();
    for (int count = below(random_, 7); count > 0; --count) {
      Json field{{"name", new_name(random_, taken_)}};
      if (!fill(field)) {
        break;
      }
      all.push_back(field);
      if (field["type"] == "bytes") {
        break;
      }
    }
    return all;
  }

 private:
  bool fill(Json& field) {
    const int which = below(random_, 10);
    if (which < 4) {
      return number(field);
    }
    if (which < 7) {
      return part(field, false);
    }
    return which < 9 ? part(field, true) : bytes(field);
  }

  bool number(Json& field) {
    const unsigned width = 8 * static_cast<unsigned>(1 + below(random_, 4));
    const bool is_signed = chance(random_, 50);
    field["type"] = (is_signed ? "i" : "u") + std::to_string(width);
    add_scale_and_range(random_, field, width, is_signed);
    return take(width, true);
  }

  bool part(Json& field, bool is_choice) {
    const unsigned width = 1 + static_cast<unsigned>(below(random_, 8));
    field["type"] = is_choice ? "enum" : "bits";
    field["width"] = width;
    if (is_choice) {
      field["values"] = choices(random_, width);
    } else {
      add_scale_and_range(random_, field, width, false);
    }
    return take(width, width == 8);
  }

  bool bytes(Json& field) {
    bit_ = (bit_ + 7) / 8 * 8;
    const int room = static_cast<int>(64 - bit_) / 8;
    field["type"] = "bytes";
    if (chance(random_, 60)) {
      const int most = below(random_, room + 1);
      field["maximum"] = most;
      field["minimum"] = below(random_, most + 1);
    }
    return true;
  }

  bool take(unsigned width, bool whole_bytes) {
    if (whole_bytes || bit_ % 8 + width > 8) {
      bit_ = (bit_ + 7) / 8 * 8;
    }
    bit_ += width;
    return bit_ <= 64;
  }

  std::mt19937& random_;
  unsigned bit_;
  std::set<std::string> taken_;
};

void add_messages(std::mt19937& random, Json& kind, const char* direction) {
  std::set<std::string> taken;
  for (int count = below(random, 7); count > 0; --count) {
    const bool has_tag = chance(random, 60);
    Json message{{"fields", MessageMaker(random, has_tag).fields()}};
    if (has_tag) {
      message["tag"] = below(random, 256);
    }
    if (chance(random, 30)) {
      message["description"] =
          descriptions.at(static_cast<std::size_t>(below(random, descriptions.size())));
    }
    Json tried = kind;
    tried[direction][new_name(random, taken)] = message;
    if (parse_kind(tried.dump(), "tried")) {  // it can be told from the others
      kind = tried;
    }
  }
}

/// What stands for a number on the wire, and up to half a step beside it.
double value_near(std::mt19937& random, const Field& field, std::int64_t raw) {
  constexpr std::array beside{0.0, 0.0, 0.25, -0.25, 0.5, -0.5};
  const double steps =
      static_cast<double>(raw) + beside.at(static_cast<std::size_t>(below(random, beside.size())));
  return steps * field.scale.numerator / field.scale.denominator;
}

std::int64_t random_raw(std::mt19937& random, const Field& field) {
  switch (below(random, 8)) {
    case 0:
      return field.minimum;
    case 1:
      return field.maximum;
    case 2:
      return chance(random, 30) ? field.maximum + 1 : field.maximum;
    default:
      return between(random, field.minimum, field.maximum);
  }
}

Bytes some_bytes(std::mt19937& random, std::int64_t count) {
  Bytes bytes;
  bytes.length = static_cast<std::uint8_t>(std::clamp<std::int64_t>(count, 0, max_data_length));
  for (std::uint8_t& byte : bytes.data) {
    byte = static_cast<std::uint8_t>(below(random, 256));
  }
  return bytes;
}

}  // namespace

std::string random_kind_text(std::mt19937& random, const std::string& name) {
  Json kind{{"roio", 1}, {"kind", name}};
  add_messages(random, kind, "hears");
  add_messages(random, kind, "says");
  return kind.dump(2);
}

Vector random_vector(std::mt19937& random, const MessageKind& message) {
  Vector vector{{}, {}, Bytes{}};
  for (const Field& field : message.fields) {
    if (field.form == Field::Form::choice) {
      const Choice& choice = field.choices.at(
          static_cast<std::size_t>(below(random, static_cast<int>(field.choices.size()))));
      vector.values.push_back({field.name, choice.name});
    } else if (field.form == Field::Form::bytes) {
      vector.values.push_back({field.name, some_bytes(random, random_raw(random, field))});
    } else {
      vector.values.push_back({field.name, value_near(random, field, random_raw(random, field))});
    }
  }
  vector.packed = pack(message, vector.values);
  if (vector.packed) {
    const std::span<const std::uint8_t> data(vector.packed->data.data(), vector.packed->length);
    for (const Reading& reading : unpack(message, data)) {
      vector.raw.push_back(reading.raw);
    }
  }
  return vector;
}

Bytes random_bytes(std::mt19937& random, const MessageKind& message) {
  const bool is_other = chance(random, 20);
  Bytes bytes =
      some_bytes(random, is_other ? below(random, 9)
                                  : between(random, message.min_length, message.max_length));
  if (chance(random, 50)) {  // small numbers are in range more often
    for (std::uint8_t& byte : bytes.data) {
      byte &= 0x03;
    }
  }
  if (message.tag && !chance(random, 20)) {
    bytes.data[0] = *message.tag;
  }
  std::fill(bytes.data.begin() + bytes.length, bytes.data.end(), std::uint8_t{0});
  return bytes;
}

}  // namespace roio::test
