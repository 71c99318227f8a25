#include "attach/words.hpp"

#include "program/words.hpp"

namespace roio::cli {
namespace {

constexpr const char* examples = R"(Examples:
  roio-cli attach serial:/dev/ttyACM0 vcan0    a bridge, for every Linux program
  roio-cli attach can0 local:robot             for programs without CAN
  roio-cli attach -v local:robot local:desk    counts once a second

Every frame goes both ways until a signal ends it. Either bus may go and come
back meanwhile, which is told; what one side does not take within a second is
lost and counted. At the end it says what was forwarded, and what was lost
where. Two buses that are joined already, also by way of others, are refused;
when frames go round all the same, that is noticed, and ends it.)";

}  // namespace

AttachWords::AttachWords(CLI::App& program)
    : app_(program.add_subcommand("attach", "Make two buses one")),
      verbose_(flag(*app_, "-v,--verbose", "Say the counts once a second")) {
  prepare(*app_, "attach [OPTIONS] BUS BUS", examples);
  without_type(app_->add_option("BUS", first_, "can0, local:NAME or serial:DEVICE"));
  without_type(app_->add_option("OTHER", second_, "Another one"));
}

AttachOptions AttachWords::parse() const {
  refuse_rest(*app_, "attach");
  if (first_.empty() || second_.empty()) {
    refuse("attach",
           first_.empty() ? "expected two buses" : "expected another BUS after the first");
  }
  return {parse_bus(first_), parse_bus(second_), verbose_->count() > 0};
}

}  // namespace roio::cli
