#include "kind/dbc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "kind/facts.hpp"
#include "kind/latin1.hpp"
#include "kind/names.hpp"
#include "kind/ways.hpp"
#include "program/exit_status.hpp"

namespace roio::cli {
namespace {

constexpr std::size_t longest_name = 32;  // of an identifier in a DBC file
constexpr std::uint32_t extended = 0x80000000;
constexpr unsigned byte_bits = 8;

/// In double quotes, which cannot stand in a DBC's text.
std::string dbc_string(std::string_view text) {
  std::string line = one_line(text);
  std::replace(line.begin(), line.end(), '"', '\'');
  std::replace(line.begin(), line.end(), '\\', '/');
  return '"' + line + '"';
}

/// Where the highest bit is, as DBC counts: bit 7 of a byte is its highest.
unsigned start_of(unsigned first_bit) {
  return first_bit / byte_bits * byte_bits + (byte_bits - 1 - first_bit % byte_bits);
}

std::string names_of(const std::vector<const MessageKind*>& messages) {
  std::string text;
  for (const MessageKind* message : messages) {
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", message->name, length_of(*message));
  }
  return text;
}

/// What a DBC has in several places: lines of messages, and behind all of them comments and tables.
class Writer {
 public:
  Writer(const Robot& robot, std::string_view source) : robot_(robot) {
    for (const Place& place : robot.places) {
      nodes_[&place] = node_names_.add(identifier(place.name), longest_name);
    }
    head_ =
        fmt::format("VERSION {}\n\nNS_ :\n\nBS_:\n\nBU_:", dbc_string(origin("robot dbc", source)));
    for (const Place& place : robot.places) {
      head_ += ' ' + nodes_[&place];
      comments_ +=
          fmt::format("CM_ BU_ {} {};\n", nodes_[&place], dbc_string(description_of(place)));
    }
    head_ += "\n\n";
  }

  void add(const Way& way) {
    const Distinction distinction = distinguish(way.messages);
    const std::string destination =
        way.destination == nullptr ? fmt::format("all_{}", way.subnet) : nodes_[way.destination];
    id_ = pack_id(way.header()) | extended;
    receivers_ = receivers_of(way);
    signals_ = Scope();
    std::size_t length = 0;
    for (const MessageKind* message : way.messages) {
      length = std::max<std::size_t>(length, message->max_length);
    }
    messages_ +=
        fmt::format("BO_ {} {}: {} {}\n", id_,
                    message_names_.add(nodes_[way.source] + "_to_" + destination, longest_name),
                    length, nodes_[way.source]);
    add_tag(distinction.told);
    for (const MessageKind* message : distinction.told) {
      for (const Field& field : message->fields) {
        add_field(*message, field);
      }
    }
    messages_ += '\n';
    comment(way, distinction);
  }

  [[nodiscard]] std::size_t size() const {
    return head_.size() + messages_.size() + comments_.size() + tables_.size();
  }

  [[nodiscard]] Dbc finish() {
    Latin1 text = to_latin1(head_ + messages_ + general_comment() + comments_ + tables_);
    if (text.replaced > 0) {
      notes_.push_back(
          fmt::format("characters that ISO 8859-1 does not have: {}; each is a ?", text.replaced));
    }
    return {std::move(text.text), std::move(notes_)};
  }

 private:
  static std::string description_of(const Place& place) {
    return fmt::format("{}{}{}{}{}", roio::to_string(place.address), place.kind ? ", " : "",
                       place.kind ? place.kind->name : "", place.description.empty() ? "" : ": ",
                       place.description);
  }

  [[nodiscard]] std::string general_comment() const {
    return fmt::format("CM_ {};\n",
                       dbc_string(fmt::format(
                           "{}. Messages of normal priority between its places; urgent ones have "
                           "other identifiers, and are not in here.",
                           robot_.name)));
  }

  [[nodiscard]] std::string receivers_of(const Way& way) {
    if (way.destination != nullptr) {
      return nodes_[way.destination];
    }
    std::string text;
    for (const Place& place : robot_.places) {
      if (place.address.subnet == way.subnet && &place != way.source) {
        text += (text.empty() ? "" : ",") + nodes_[&place];
      }
    }
    return text.empty() ? "Vector__XXX" : text;
  }

  /// The tag of messages that have one, by which their signals are chosen.
  void add_tag(const std::vector<const MessageKind*>& told) {
    if (told.empty() || !told.front()->tag) {
      return;
    }
    const std::string name = signals_.add("tag");
    messages_ += fmt::format(" SG_ {} M : 7|8@0+ (1,0) [0|255] \"\" {}\n", name, receivers_);
    tables_ += fmt::format("VAL_ {} {}", id_, name);
    for (const MessageKind* message : told) {
      tables_ += fmt::format(" {} {}", *message->tag, dbc_string(message->name));
    }
    tables_ += " ;\n";
  }

  void add_field(const MessageKind& message, const Field& field) {
    const std::string wanted = identifier(message.name) + '_' + identifier(field.name);
    if (field.form != Field::Form::bytes) {
      add_signal(message, field, wanted);
      return;
    }
    Field byte;  // a signal for each: a shorter message lacks the last
    byte.description = field.description;
    byte.maximum = 255;
    for (std::int64_t i = 0; i < field.maximum; ++i) {
      byte.first_bit = static_cast<std::uint8_t>(field.first_bit + i * byte_bits);
      add_signal(message, byte, fmt::format("{}_{}", wanted, i));
    }
  }

  void add_signal(const MessageKind& message, const Field& field, const std::string& wanted) {
    const std::string name = signals_.add(wanted, longest_name);
    const bool is_choice = field.form == Field::Form::choice;
    const double step = static_cast<double>(field.scale.numerator) / field.scale.denominator;
    const std::string range = is_choice ? fmt::format("0|{}", (1U << field.width) - 1)
                                        : fmt::format("{}|{}", in_unit(field, field.minimum),
                                                      in_unit(field, field.maximum));
    messages_ +=
        fmt::format(" SG_ {} {}: {}|{}@0{} ({},0) [{}] {} {}\n", name,
                    message.tag ? fmt::format("m{} ", *message.tag) : "", start_of(field.first_bit),
                    field.width, field.form == Field::Form::signed_number ? '-' : '+', step, range,
                    dbc_string(field.unit), receivers_);
    if (!field.description.empty()) {
      comments_ += fmt::format("CM_ SG_ {} {} {};\n", id_, name, dbc_string(field.description));
    }
    if (is_choice) {
      tables_ += fmt::format("VAL_ {} {}", id_, name);
      for (const Choice& choice : field.choices) {
        tables_ += fmt::format(" {} {}", choice.raw, dbc_string(choice.name));
      }
      tables_ += " ;\n";
    }
  }

  /// What the messages are; and which have no signals here, and why.
  void comment(const Way& way, const Distinction& distinction) {
    std::string text;
    for (const MessageKind* message : way.messages) {
      text += fmt::format("{}{}: {}{}{}{}", text.empty() ? "" : "; ", message->name,
                          length_of(*message),
                          message->tag ? fmt::format(", tag {}", *message->tag) : "",
                          message->description.empty() ? "" : ". ", message->description);
    }
    if (!distinction.untold.empty()) {
      const std::string why =
          fmt::format("without signals, as a DBC tells messages apart by their tag alone: {}",
                      names_of(distinction.untold));
      text += "; " + why;
      notes_.push_back(fmt::format("{} to {}: {}", way.source->name,
                                   robot_.name_of(way.header().destination), why));
    }
    comments_ += fmt::format("CM_ BO_ {} {};\n", id_, dbc_string(text));
  }

  const Robot& robot_;
  std::map<const Place*, std::string> nodes_;
  Scope node_names_{"Vector__XXX", "BU_", "BO_", "SG_"};
  Scope message_names_;
  std::string head_, messages_, comments_, tables_;
  std::vector<std::string> notes_;
  // Of the way that is being written:
  Scope signals_;
  std::uint32_t id_ = 0;
  std::string receivers_;
};

}  // namespace

Dbc robot_dbc(const Robot& robot, std::string_view source, std::size_t most) {
  Writer writer(robot, source);
  for (const Way& way : ways_of(robot)) {
    writer.add(way);
    if (writer.size() > most) {
      throw Failure(fmt::format("{}: its DBC has more than {} MiB; expected at most so many",
                                source, most >> 20U));
    }
  }
  return writer.finish();
}

}  // namespace roio::cli
