# Runs firmware on a simulated atmega328p and checks what it says on its serial port.
#   cmake -DSIMAVR=... -DFIRMWARE=... -DDOCUMENT=... -P run_firmware.cmake
cmake_minimum_required(VERSION 3.25)

execute_process(COMMAND ${SIMAVR} -m atmega328p -f 16000000 ${FIRMWARE}
                OUTPUT_VARIABLE output ERROR_VARIABLE output TIMEOUT 60 RESULT_VARIABLE result)
# simavr colours what comes from the serial port, and shows line ends as dots.
string(ASCII 27 escape)
string(REGEX REPLACE "${escape}\\[[0-9;]*m" "" output "${output}")
message("${output}")

# The examples counted in the document, without the parser that made the firmware.
file(READ ${DOCUMENT} document)
string(REGEX REPLACE ".*<!-- worked examples: begin -->" "" table "${document}")
string(REGEX MATCHALL "\n\\| [^|]+\\| (urgent|normal) " rows "${table}")
list(LENGTH rows count)

# The stack as filter_mcp2515.hpp promises it.
foreach(expected IN ITEMS "${count} of ${count} vectors agree" "plain node agrees"
                          "fit of 2 rules: [1-3][0-9][0-9] bytes of stack, exact"
                          "fit of 8 rules: [1-6][0-9][0-9] bytes of stack, not exact" "end")
  if(NOT output MATCHES "(^|\n)${expected}\\.?(\n|$)")
    message(FATAL_ERROR "expected the line \"${expected}\" (simavr ended with ${result})")
  endif()
endforeach()
