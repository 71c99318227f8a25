/// Roio for host programs: everything but JSON (roio/json.hpp, target roio::json) and robots with
/// names (roio/robot.hpp, target roio::robot).
#ifndef ROIO_HPP
#define ROIO_HPP

#include <roio/bridge.hpp>
#include <roio/bus.hpp>
#include <roio/bus_list.hpp>
#include <roio/candump_log.hpp>
#include <roio/error.hpp>
#include <roio/filter_mcp2515.hpp>
#include <roio/filter_socketcan.hpp>
#include <roio/frame_length.hpp>
#include <roio/message.hpp>
#include <roio/node.hpp>
#include <roio/text.hpp>
#include <roio/version.hpp>

#endif
