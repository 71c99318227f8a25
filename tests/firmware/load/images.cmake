# The sketches whose figures are measured, for tests/firmware/load and bench/firmware alike.
include_guard(GLOBAL)

set(load_sketches ${CMAKE_CURRENT_LIST_DIR}/sketches)
set(load_examples ${PROJECT_SOURCE_DIR}/firmware/arduino/examples)
set(load_made ${PROJECT_BINARY_DIR}/firmware_load)
add_custom_target(load_images)

# <Name>.ino, out of `text`, as an image for each of the boards. Who wants them depends on load_images.
function(add_load_image name text)
  file(CONFIGURE OUTPUT ${load_made}/${name}/${name}.ino CONTENT "${text}" @ONLY)
  foreach(board IN LISTS ARGN)
    add_arduino_image(load_image_${board}_${name} ${board} ${load_made}/${name}/${name}.ino)
    add_dependencies(load_images load_image_${board}_${name})
  endforeach()
endfunction()

# Reads a sketch, and again when it is changed.
function(read_sketch file variable)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  file(READ ${file} text)
  set(${variable} "${text}" PARENT_SCOPE)
endfunction()

# One of sketches/ under another name, for the Uno; each further argument is what to #define.
function(add_load_variant name sketch)
  read_sketch(${load_sketches}/${sketch}/${sketch}.ino text)
  set(defines "")
  foreach(define IN LISTS ARGN)
    string(APPEND defines "#define ${define}\n")
  endforeach()
  add_load_image(${name} "${defines}${text}" uno)
endfunction()

# --- size ---------------------------------------------------------------------------

foreach(name IN ITEMS Empty SerialEcho)
  read_sketch(${PROJECT_SOURCE_DIR}/tests/firmware/arduino/sketches/${name}/${name}.ino text)
  add_load_image(Size${name} "${text}" uno)
endforeach()
# Echo, with other nodes.
read_sketch(${load_examples}/Echo/Echo.ino echo)
set(plain_node "RoioOn<10> roio")
string(FIND "${echo}" "${plain_node};" found)
if(found EQUAL -1)
  message(FATAL_ERROR "Echo.ino has no '${plain_node};' for tests/firmware/load/images.cmake to replace")
endif()
string(REPLACE "${plain_node}" "RoioOn<10, 2> roio" text "${echo}")
add_load_image(EchoInterrupt "${text}" uno)
string(REPLACE "${plain_node}" "Roio roio(10)" text "${echo}")
add_load_image(EchoSetPin "${text}" uno)
add_load_image(EchoPortable "#define ROIO_PORTABLE_PINS\n${echo}" uno)
add_load_variant(EchoClassic ClassicEcho)

# --- time ---------------------------------------------------------------------------

set(interrupt_node "NODE RoioOn<10, 2> roio")
add_load_variant(CallTimePolled CallTime)
add_load_variant(CallTimeInterrupt CallTime ${interrupt_node})
add_load_variant(CallTimeSetPin CallTime "NODE Roio roio(10)")
add_load_variant(CallTimePortable CallTime ROIO_PORTABLE_PINS)
add_load_variant(CallTimeClassic ClassicCallTime)

# --- a saturated bus ----------------------------------------------------------------

foreach(kbps IN ITEMS 1000 500 250 125)
  set(timing "TIMING Roio::bitTiming<16000000, ${kbps}000>()")
  add_load_variant(SaturatedPolled${kbps} Saturated ${timing})
  add_load_variant(SaturatedInterrupt${kbps} Saturated ${timing} ${interrupt_node})
endforeach()
set(timing "TIMING Roio::bitTiming<8000000, 500000>()")
add_load_variant(SaturatedPolled500At8 Saturated ${timing})
add_load_variant(SaturatedInterrupt500At8 Saturated ${timing} ${interrupt_node})
add_load_variant(SaturatedSlow Saturated "WORK 4000")

# --- and what else is held ----------------------------------------------------------

read_sketch(${load_sketches}/Counts/Counts.ino counts)
add_load_image(EchoCounts "#define setup echoSetup\n#define loop echoLoop\n${echo}${counts}" uno)
add_load_variant(Urgent Urgent)
add_load_variant(InterruptsOffPolled InterruptsOff)
add_load_variant(InterruptsOffInterrupt InterruptsOff ${interrupt_node})
add_load_variant(InterruptsOffPortable InterruptsOff ROIO_PORTABLE_PINS)
add_load_variant(InterruptsOffClassic ClassicInterruptsOff)
add_load_variant(SharedBusPolled SharedBus)
add_load_variant(SharedBusInterrupt SharedBus ${interrupt_node})
add_load_variant(SharedBusPortable SharedBus ROIO_PORTABLE_PINS)
read_sketch(${load_sketches}/PinMap/PinMap.ino text)
add_load_image(PinMap "${text}" ${ROIO_BOARDS})

# --- the measurements themselves ----------------------------------------------------

set(sources bit_errors.cpp call_time.cpp saturation.cpp)
list(TRANSFORM sources PREPEND ${CMAKE_CURRENT_LIST_DIR}/)
add_library(firmware_load STATIC ${sources})
target_include_directories(firmware_load PUBLIC ${CMAKE_CURRENT_LIST_DIR})
target_compile_definitions(firmware_load PUBLIC ROIO_IMAGES_DIR="${ROIO_IMAGES_DIR}")
target_link_libraries(firmware_load PUBLIC roio::sim_board roio::core PRIVATE roio_warnings)

