/// The cells of a row of `roio-cli top`, as texts.
#ifndef ROIO_CLI_ROW_TEXT_HPP
#define ROIO_CLI_ROW_TEXT_HPP

#include <string>

#include "form/labels.hpp"
#include "top/traffic_table.hpp"

namespace roio::cli {

struct RowText {
  bool is_message = true;
  std::string source;       ///< Of what is no message, "11-bit" or "29-bit".
  std::string destination;  ///< Of what is no message, its identifier.
  std::string priority;
  std::string message_class;  ///< Of what is no message, "foreign".
  std::string message;
  std::string rate;
  std::string age;
  std::string fields;  ///< Empty: the bytes are shown.
};

RowText row_text(const TrafficRow& row, const Labels& labels);

/// Frames a second with three digits: "0.05", "12.3", "8123"; "-" for none.
std::string rate_text(double rate);
/// "0.1 s", "45 s", "12 min", "3 h".
std::string age_text(Timeout age);

}  // namespace roio::cli

#endif
