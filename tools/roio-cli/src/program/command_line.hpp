/// What the words of the command line ask for.
#ifndef ROIO_CLI_COMMAND_LINE_HPP
#define ROIO_CLI_COMMAND_LINE_HPP

#include <string>
#include <variant>

#include "ask/ask.hpp"
#include "attach/attach.hpp"
#include "bridge/bridge.hpp"
#include "buses/buses.hpp"
#include "buses/hub.hpp"
#include "dump/dump.hpp"
#include "gen/check.hpp"
#include "gen/gen.hpp"
#include "kind/commands.hpp"
#include "record/play.hpp"
#include "record/record.hpp"
#include "send/send.hpp"
#include "top/top.hpp"

namespace roio::cli {

/// A text to print instead of doing anything: --help, --version.
struct Information {
  std::string text;
};

using Command =
    std::variant<Information, SendOptions, AskOptions, DumpOptions, TopOptions, RecordOptions,
                 PlayOptions, GenOptions, CheckOptions, BusesOptions, HubOptions, AttachOptions,
                 BridgeShowOptions, BridgeSetOptions, BridgeIdentifyOptions, KindOptions,
                 RobotDbcOptions, RobotCheckOptions>;

/// @throws UsageError: what was wrong with the words, and what was expected.
Command parse_command_line(int argc, const char* const* argv);

}  // namespace roio::cli

#endif
