# What an object file for an AVR needs from elsewhere: no heap, no exceptions, no floating point, and no
# 64-bit arithmetic.
#   cmake -DNM=... -DOBJECT=... -P check_object.cmake
cmake_minimum_required(VERSION 3.25)

execute_process(COMMAND ${NM} --undefined-only ${OBJECT} OUTPUT_VARIABLE undefined COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "U [^\n]+" needed "${undefined}")
message("${needed}")
if(NOT needed)
  message(FATAL_ERROR "the object file is empty: nothing was looked at")
endif()
foreach(symbol IN LISTS needed)
  string(SUBSTRING "${symbol}" 2 -1 symbol)
  # operator new and delete, malloc; unwinding; libgcc's float, double and 64-bit functions.
  if(symbol MATCHES "^_Z(nw|na|dl|da)|malloc|calloc|free$|__cxa|_Unwind|__gxx|sf[23]$|df[23]$|di[23]$|[su]?float|fix(uns)?[sd]f|__(add|sub|mul|u?div|u?mod|ash[lr]|lshr|neg|cmp)di")
    message(FATAL_ERROR "the driver needs ${symbol}")
  endif()
endforeach()
