#include "vectors.hpp"

#include <fstream>
#include <map>
#include <stdexcept>

namespace roio::test {
namespace {

constexpr const char* begin_mark = "<!-- worked examples: begin -->";
constexpr const char* end_mark = "<!-- worked examples: end -->";
constexpr std::size_t columns = 14;

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(' ');
  return first == std::string::npos ? ""
                                    : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

std::vector<std::string> cells_of(const std::string& row) {
  std::vector<std::string> cells;
  for (std::size_t begin = 1, end = 0; (end = row.find('|', begin)) != std::string::npos;
       begin = end + 1) {
    cells.push_back(trimmed(row.substr(begin, end - begin)));
  }
  if (cells.size() != columns) {
    throw std::runtime_error("expected " + std::to_string(columns) + " cells, found " +
                             std::to_string(cells.size()));
  }
  return cells;
}

unsigned long number(const std::string& text, int base, unsigned long max) {
  std::size_t used = 0;
  const unsigned long value = std::stoul(text, &used, base);
  if (used != text.size() || value > max) {
    throw std::runtime_error("expected a number up to " + std::to_string(max) + ", found " + text);
  }
  return value;
}

std::uint8_t byte(const std::string& text, int base = 16) {
  return static_cast<std::uint8_t>(number(text, base, 0xFF));
}

Address address(const std::string& text) {
  const auto dot = text.find('.');
  const std::string node = text.substr(dot + 1);
  return {byte(text.substr(0, dot), 10), node == "*" ? broadcast_node : byte(node, 10)};
}

Message message(const std::vector<std::string>& cells) {
  static const std::map<std::string, Priority> priorities = {{"urgent", Priority::urgent},
                                                             {"normal", Priority::normal}};
  static const std::map<std::string, MessageClass> classes = {{"message", MessageClass::message},
                                                              {"system", MessageClass::system},
                                                              {"stream", MessageClass::stream}};
  Message result{};
  result.header = {priorities.at(cells[1]), classes.at(cells[2]), address(cells[3]),
                   address(cells[4])};
  const std::string data = cells[5] == "-" ? "" : cells[5];
  if (data.size() % 2 != 0 || data.size() > 2 * max_data_length) {
    throw std::runtime_error("expected 0..8 bytes of two digits each, found " + data);
  }
  result.length = static_cast<std::uint8_t>(data.size() / 2);
  for (std::size_t i = 0; i < result.length; ++i) {
    result.data[i] = byte(data.substr(2 * i, 2));
  }
  return result;
}

Vector vector_of(const std::string& row, int line) {
  const std::vector<std::string> cells = cells_of(row);
  return {cells[0],
          line,
          message(cells),
          static_cast<std::uint32_t>(number(cells[6], 16, id_mask)),
          cells[7],
          byte(cells[8], 10),
          static_cast<std::uint16_t>(number(cells[9], 16, 0x7FFF)),
          {byte(cells[10]), byte(cells[11]), byte(cells[12]), byte(cells[13])}};
}

bool is_rule_or_heading(const std::string& row) {
  return row.starts_with("|-") || row.starts_with("| name ");
}

}  // namespace

std::vector<Vector> read_vectors(const std::string& path) {
  std::ifstream file(path);
  std::vector<Vector> vectors;
  bool inside = false;
  int line = 0;
  for (std::string row; std::getline(file, row);) {
    ++line;
    if (row == begin_mark || row == end_mark) {
      inside = row == begin_mark;
    } else if (inside && row.starts_with('|') && !is_rule_or_heading(row)) {
      try {
        vectors.push_back(vector_of(row, line));
      } catch (const std::exception& error) {
        throw std::runtime_error(path + ":" + std::to_string(line) + ": " + error.what());
      }
    }
  }
  if (vectors.empty()) {
    throw std::runtime_error(path + ": no worked examples between the marks");
  }
  return vectors;
}

}  // namespace roio::test
