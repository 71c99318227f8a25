/// How long receive() and send() take, from call to return, without the bracket that measures them.
#ifndef ROIO_TESTS_FIRMWARE_LOAD_CALL_TIME_HPP
#define ROIO_TESTS_FIRMWARE_LOAD_CALL_TIME_HPP

#include <map>
#include <string>

namespace roio::load {

/// How many calls took so many cycles of the processor, 16 to a microsecond.
using CallTimes = std::map<int, int>;

struct CallTimeReport {
  int bracket = 0;     ///< Cycles, subtracted from all others.
  CallTimes receive;   ///< That gave a message.
  CallTimes nothing;   ///< That found none.
  CallTimes send;      ///< That took the message.
  int bus_frames = 0;  ///< That came back.
};

/// The most common one, and of equals the longer; 0 of none.
int usual(const CallTimes& times);
int shortest(const CallTimes& times);
int longest(const CallTimes& times);

/// @param image made from CallTime. @param length of the messages' data.
/// @param messages how many, 2 ms and some apart, so that they come at any phase of the loop.
/// @param in_pairs two at a time, both in the chip before it is looked at: of the second the driver
///        knows already when it has read the first.
CallTimeReport measure_calls(const std::string& image, int length, int messages, bool in_pairs);

}  // namespace roio::load

#endif
