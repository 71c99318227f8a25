#include "top/view.hpp"

#include <algorithm>
#include <array>
#include <roio/message.hpp>
#include <tuple>

#include "top/facts.hpp"
#include "top/line.hpp"
#include "top/row_line.hpp"

namespace roio::cli {
namespace {

/// What stands above and below the rows, as far as there is room.
struct Surroundings {
  std::size_t facts;
  bool titles;
  bool keys;

  explicit Surroundings(Size size)
      : facts(size.lines >= 8   ? 3
              : size.lines >= 4 ? 2
                                : std::min<std::size_t>(size.lines, 1)),
        titles(size.lines >= 5),
        keys(size.lines >= 6) {}

  [[nodiscard]] std::size_t lines() const { return facts + (titles ? 1 : 0) + (keys ? 1 : 0); }
};

constexpr std::array<const char*, 5> sort_names{"source", "destination", "rate", "age", "frames"};

constexpr std::array<const char*, 9> help_lines{{
    "q, Ctrl-C      end",
    "s              sort by source, destination, rate, age, frames",
    "r              the other way round",
    "p, space       stand still, and go on; meanwhile all is counted",
    "c              forget all rows and counts",
    "arrows, j k    a row down, up",
    "PgDn PgUp, f b a screen down, up",
    "End Home, G g  the last row, the first",
    "h, ?           this page, and away with it",
}};

/// Source, then destination; what is no message stands behind those that are.
auto by_source(const TrafficRow& row) {
  Message message{};  // of what is none, all zeros: its identifier alone counts
  const bool foreign = to_message(row.last, message) != Status::ok;
  const Header& header = message.header;
  return std::tuple(foreign, header.source.subnet, header.source.node, header.destination.subnet,
                    header.destination.node, tagged_id(row.last), row.last.length);
}

auto by_destination(const TrafficRow& row) {
  const auto [foreign, source_subnet, source_node, subnet, node, id, length] = by_source(row);
  return std::tuple(foreign, subnet, node, source_subnet, source_node, id, length);
}

bool is_before(const TrafficRow& a, const TrafficRow& b, SortKey key) {
  switch (key) {
    case SortKey::destination:
      return by_destination(a) < by_destination(b);
    case SortKey::rate:
      return a.rate > b.rate;
    case SortKey::age:
      return a.age < b.age;
    case SortKey::frames:
      return a.frames > b.frames;
    case SortKey::source:
      break;
  }
  return by_source(a) < by_source(b);
}

std::size_t last_first_row(std::size_t rows, Size size) {
  const std::size_t room = rows_on_screen(size);
  return rows > room ? rows - room : 0;
}

Line keys_line(const View& view, std::size_t first, std::size_t shown, std::size_t rows, Size size,
               bool colour) {
  Line line(size.columns, colour);
  const std::string range = rows > shown
                                ? " rows " + std::to_string(first + 1) + "-" +
                                      std::to_string(first + shown) + " of " + std::to_string(rows)
                                : "";
  constexpr std::size_t needed_by_all = 72;
  const std::string sort =
      std::string("s sort: ") + sort_names.at(static_cast<std::size_t>(view.sort));
  const std::string keys = size.columns < needed_by_all
                               ? "q quit  h help  " + sort
                               : "q quit  " + sort + "  r reverse  p " +
                                     (view.paused ? "go on" : "pause") + "  c clear  h help";
  // The range says that there is more than is seen: rather some keys less.
  const std::size_t room = size.columns - std::min(size.columns, range.size());
  line.add_left(keys, room, Style::bar);
  line.add(range, Style::bar);
  return line;
}

void add_help(std::vector<std::string>& lines, Size size, bool colour) {
  for (const char* text : help_lines) {
    Line line(size.columns, colour);
    line.add(text);
    lines.push_back(line.text());
  }
}

}  // namespace

std::size_t rows_on_screen(Size size) {
  const std::size_t others = Surroundings(size).lines();
  return size.lines > others ? size.lines - others : 0;
}

View after(View view, Action action, std::size_t rows, Size size) {
  const std::size_t page = std::max<std::size_t>(rows_on_screen(size), 1);
  const std::size_t last = last_first_row(rows, size);
  std::size_t& first = view.first_row;
  first = std::min(first, last);
  switch (action) {
    case Action::sort:
      view.sort =
          static_cast<SortKey>((static_cast<std::size_t>(view.sort) + 1) % sort_names.size());
      break;
    case Action::reverse:
      view.reversed = !view.reversed;
      break;
    case Action::pause:
      view.paused = !view.paused;
      break;
    case Action::help:
      view.help = !view.help;
      break;
    case Action::line_up:
      first -= std::min<std::size_t>(first, 1);
      break;
    case Action::line_down:
      first = std::min(first + 1, last);
      break;
    case Action::page_up:
      first -= std::min(first, page);
      break;
    case Action::page_down:
      first = std::min(first + page, last);
      break;
    case Action::to_first:
    case Action::clear:
      first = 0;
      break;
    case Action::to_last:
      first = last;
      break;
    case Action::quit:
      break;
  }
  return view;
}

std::vector<TrafficRow> sorted(std::vector<TrafficRow> rows, const View& view) {
  const auto compare = [&](const TrafficRow& a, const TrafficRow& b) {
    if (is_before(a, b, view.sort) != is_before(b, a, view.sort)) {
      return is_before(a, b, view.sort) != view.reversed;
    }
    return by_source(a) < by_source(b);  // so that equal ones do not dance
  };
  std::sort(rows.begin(), rows.end(), compare);
  return rows;
}

std::vector<std::string> draw(const Snapshot& snapshot, const View& view, const Labels& labels,
                              Size size, bool colour) {
  const Surroundings around(size);
  std::vector<std::string> lines = fact_lines(snapshot, view.paused, size.columns, colour);
  lines.resize(around.facts);
  const std::size_t room = rows_on_screen(size);
  const std::size_t count = snapshot.rows.size();
  const std::size_t first = std::min(view.first_row, last_first_row(count, size));
  const std::size_t shown = std::min(room, count - first);
  std::vector<RowText> texts;
  const std::vector<TrafficRow> rows = sorted(snapshot.rows, view);
  for (std::size_t i = first; i < first + shown; ++i) {
    texts.push_back(row_text(rows[i], labels));
  }
  const RowLayout layout(texts, size.columns);
  if (around.titles) {
    lines.push_back(title_line(layout, colour));
  }
  if (view.help) {
    add_help(lines, size, colour);
  } else {
    for (std::size_t i = 0; i < shown; ++i) {
      lines.push_back(row_line(layout, rows[first + i], texts[i], colour));
    }
    if (count == 0 && room > 0) {
      lines.emplace_back(std::string("nothing heard yet").substr(0, size.columns));
    }
  }
  lines.resize(size.lines - (around.keys ? 1 : 0));
  if (around.keys) {
    lines.push_back(keys_line(view, first, shown, count, size, colour).text());
  }
  return lines;
}

}  // namespace roio::cli
