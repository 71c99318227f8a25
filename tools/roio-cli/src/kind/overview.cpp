#include "kind/overview.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <vector>

#include "kind/facts.hpp"

namespace roio::cli {
namespace {

std::string counted(std::size_t count, const char* one) {
  return fmt::format("{} {}{}", count, one, count == 1 ? "" : "s");
}

/// Columns of texts, the last as long as it likes.
std::string table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) {
      widths[i] = std::max(widths[i], row[i].size());
    }
  }
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      text += fmt::format("{:<{}}  ", row[i], widths[i]);
    }
    text.erase(text.find_last_not_of(' ') + 1);
    text += '\n';
  }
  return text;
}

std::string first_line(const Robot& robot) {
  std::string text = robot.name;
  text += robot.version.empty() ? "" : ", version " + robot.version;
  text += robot.serial_number.empty() ? "" : ", serial number " + robot.serial_number;
  text += robot.maker.empty() ? "" : ", by " + robot.maker;
  return one_line(text) + '\n';
}

std::string bus_line(const Robot& robot) {
  if (robot.bus.empty() && !robot.bitrate) {
    return "";
  }
  return fmt::format("bus{}{}{}\n", robot.bus.empty() ? "" : " ", robot.bus,
                     robot.bitrate ? fmt::format(", {} bit/s", *robot.bitrate) : "");
}

std::string messages(const Kind& kind, const char* what, const std::vector<MessageKind>& all) {
  if (all.empty()) {
    return "";
  }
  std::vector<std::vector<std::string>> rows;
  for (const MessageKind& message : all) {
    std::string fields;
    for (const Field& field : message.fields) {
      fields += (fields.empty() ? "" : ", ") + field.name;
    }
    rows.push_back({"  " + message.name, length_of(message),
                    message.tag ? fmt::format("tag {}", *message.tag) : "", fields});
  }
  return fmt::format("{} {}\n", kind.name, what) + table(rows);
}

}  // namespace

std::string overview(const Robot& robot) {
  std::vector<std::vector<std::string>> places;
  std::set<std::string> known;
  std::string kinds;
  for (const Place& place : robot.places) {
    places.push_back({"  " + to_string(place.address), place.name,
                      place.kind ? place.kind->name : "", one_line(place.description)});
    if (place.kind && known.insert(place.kind->name).second) {
      kinds += messages(*place.kind, "hears", place.kind->heard);
      kinds += messages(*place.kind, "says", place.kind->said);
    }
  }
  return first_line(robot) + bus_line(robot) +
         fmt::format("{}, {}\n", counted(places.size(), "place"), counted(known.size(), "kind")) +
         table(places) + kinds;
}

}  // namespace roio::cli
