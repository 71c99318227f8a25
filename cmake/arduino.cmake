# The Arduino library as a zip, and sketches built from that zip as Arduino itself builds them.
#
#   arduino_library  target: <build>/Roio-<version>.zip, for the Arduino IDE's "Add .ZIP Library"
#   arduino_images   target: every example of the library, for every board
#   ROIO_IMAGES_DIR  where images are: ${ROIO_IMAGES_DIR}/<board>/<Sketch>.elf, a .log beside each
#   ROIO_BOARDS      uno, leonardo, mega
#   add_arduino_image(<target> <board> <sketch.ino>)
#
# Images are built when asked for. Who uses one depends on its target, image_<board>_<Sketch> for an
# example, or on arduino_images.
find_package(Python3 REQUIRED COMPONENTS Interpreter)

set(roio_arduino_dir ${PROJECT_SOURCE_DIR}/firmware/arduino)
set(ROIO_IMAGES_DIR ${PROJECT_BINARY_DIR}/firmware CACHE INTERNAL "Where Arduino images are")
set(ROIO_LIBRARY_ZIP ${PROJECT_BINARY_DIR}/Roio-${PROJECT_VERSION}.zip CACHE INTERNAL "The Arduino library")
set(ROIO_LIBRARY_TREES
    ${PROJECT_SOURCE_DIR}/libroio/core/include
    ${PROJECT_SOURCE_DIR}/firmware/mcp2515/include
    ${PROJECT_SOURCE_DIR}/firmware/arduino/include
    CACHE INTERNAL "What the Arduino library's src is made of")

# --- the zip ------------------------------------------------------------------------

configure_file(${roio_arduino_dir}/library.properties.in library/library.properties @ONLY)
configure_file(${roio_arduino_dir}/library.json.in library/library.json @ONLY)
set(library_top ${CMAKE_CURRENT_BINARY_DIR}/library/library.properties
                ${CMAKE_CURRENT_BINARY_DIR}/library/library.json
                ${roio_arduino_dir}/keywords.txt ${roio_arduino_dir}/README.md
                ${PROJECT_SOURCE_DIR}/LICENSE)
set(library_sources ${library_top})
foreach(tree IN LISTS ROIO_LIBRARY_TREES)
  file(GLOB_RECURSE files CONFIGURE_DEPENDS ${tree}/*)
  list(APPEND library_sources ${files})
endforeach()
file(GLOB_RECURSE files CONFIGURE_DEPENDS ${roio_arduino_dir}/examples/*)
list(APPEND library_sources ${files})
# A file that is gone makes nothing newer; this list is.
file(CONFIGURE OUTPUT library/sources CONTENT "${library_sources}\n" @ONLY)

set(ROIO_LIBRARY_COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/cmake/arduino_library.py)
foreach(file IN LISTS library_top)
  list(APPEND ROIO_LIBRARY_COMMAND --top ${file})
endforeach()
foreach(tree IN LISTS ROIO_LIBRARY_TREES)
  list(APPEND ROIO_LIBRARY_COMMAND --tree ${tree})
endforeach()
list(APPEND ROIO_LIBRARY_COMMAND --examples ${roio_arduino_dir}/examples)
set(ROIO_LIBRARY_COMMAND ${ROIO_LIBRARY_COMMAND} CACHE INTERNAL "Makes the zip that is its last argument")

add_custom_command(OUTPUT ${ROIO_LIBRARY_ZIP}
  COMMAND ${ROIO_LIBRARY_COMMAND} ${ROIO_LIBRARY_ZIP}
  DEPENDS ${library_sources} ${CMAKE_CURRENT_BINARY_DIR}/library/sources
          ${PROJECT_SOURCE_DIR}/cmake/arduino_library.py
  COMMENT "Packing the Arduino library" VERBATIM)
add_custom_target(arduino_library ALL DEPENDS ${ROIO_LIBRARY_ZIP})

# --- the tools ----------------------------------------------------------------------

if(ROIO_BUILD_FIRMWARE)
  set(required REQUIRED)
endif()
find_program(ARDUINO_BUILDER arduino-builder ${required})
find_program(ARDUINO_CTAGS arduino-ctags ${required})
find_path(ARDUINO_HARDWARE arduino/avr/boards.txt PATHS /usr/share/arduino/hardware ${required})
find_program(AVR_CXX avr-g++ ${required})
find_program(AVR_SIZE avr-size ${required})
foreach(tool IN ITEMS ARDUINO_BUILDER ARDUINO_CTAGS ARDUINO_HARDWARE AVR_CXX AVR_SIZE)
  if(NOT ${tool})
    # Who only wants the library and the tools can do without.
    add_custom_target(arduino_images
      COMMAND ${CMAKE_COMMAND} -E echo
              "No Arduino images can be built: ${tool} was not found. Run scripts/setup demo, then cmake again."
      COMMAND ${CMAKE_COMMAND} -E false VERBATIM)
    return()
  endif()
endforeach()
cmake_path(GET AVR_CXX PARENT_PATH toolchain)
cmake_path(GET toolchain PARENT_PATH toolchain)

set(ROIO_BOARDS uno leonardo mega CACHE INTERNAL "Boards that images are built for")
set(roio_fqbn_uno arduino:avr:uno CACHE INTERNAL "")
set(roio_fqbn_leonardo arduino:avr:leonardo CACHE INTERNAL "")
set(roio_fqbn_mega arduino:avr:mega:cpu=atmega2560 CACHE INTERNAL "")

set(roio_image_script ${PROJECT_SOURCE_DIR}/cmake/arduino_image.py CACHE INTERNAL "")
set(roio_image_command
    ${Python3_EXECUTABLE} ${roio_image_script} --builder ${ARDUINO_BUILDER} --ctags ${ARDUINO_CTAGS}
    --size ${AVR_SIZE} --toolchain ${toolchain} --hardware ${ARDUINO_HARDWARE}
    --cache ${ROIO_IMAGES_DIR}/core-cache CACHE INTERNAL "")

# --- what images are built from -----------------------------------------------------

# Sketches see the library as its users have it: out of the zip.
set(roio_libraries_dir ${ROIO_IMAGES_DIR}/libraries CACHE INTERNAL "")
add_custom_command(OUTPUT ${roio_libraries_dir}/unpacked
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${roio_libraries_dir}
  COMMAND ${CMAKE_COMMAND} -E make_directory ${roio_libraries_dir}
  COMMAND ${CMAKE_COMMAND} -E chdir ${roio_libraries_dir} ${CMAKE_COMMAND} -E tar xf ${ROIO_LIBRARY_ZIP}
  COMMAND ${CMAKE_COMMAND} -E touch ${roio_libraries_dir}/unpacked
  DEPENDS ${ROIO_LIBRARY_ZIP} arduino_library
  COMMENT "Unpacking the Arduino library" VERBATIM)
add_custom_target(arduino_library_unpacked DEPENDS ${roio_libraries_dir}/unpacked)

# Arduino's core is compiled once for a board, by a sketch that does nothing. All images of the board
# wait for it: two builds that find the cache empty would write it at the same time.
file(CONFIGURE OUTPUT Core/Core.ino CONTENT "void setup() {}\nvoid loop() {}\n")
foreach(board IN LISTS ROIO_BOARDS)
  file(MAKE_DIRECTORY ${ROIO_IMAGES_DIR}/${board})
  set(core ${ROIO_IMAGES_DIR}/${board}/Core.elf)
  add_custom_command(OUTPUT ${core} BYPRODUCTS ${ROIO_IMAGES_DIR}/${board}/Core.log
    COMMAND ${roio_image_command} --fqbn ${roio_fqbn_${board}}
            ${CMAKE_CURRENT_BINARY_DIR}/Core/Core.ino ${core}
    DEPENDS ${roio_image_script} ${CMAKE_CURRENT_BINARY_DIR}/Core/Core.ino
    COMMENT "Compiling Arduino's core for ${board}" VERBATIM)
  add_custom_target(arduino_core_${board} DEPENDS ${core})
endforeach()

# Target <target> builds a sketch, X/X.ino, into ${ROIO_IMAGES_DIR}/<board>/X.elf.
function(add_arduino_image target board sketch)
  cmake_path(ABSOLUTE_PATH sketch)
  cmake_path(GET sketch STEM name)
  cmake_path(GET sketch PARENT_PATH folder)
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${folder}/*)
  set(image ${ROIO_IMAGES_DIR}/${board}/${name})
  add_custom_command(OUTPUT ${image}.elf BYPRODUCTS ${image}.log
    COMMAND ${roio_image_command} --fqbn ${roio_fqbn_${board}} --libraries ${roio_libraries_dir}
            ${sketch} ${image}.elf
    DEPENDS ${sources} ${roio_image_script}
            ${roio_libraries_dir}/unpacked arduino_library_unpacked
            ${ROIO_IMAGES_DIR}/${board}/Core.elf arduino_core_${board}
    COMMENT "Building ${name} for ${board}" VERBATIM)
  add_custom_target(${target} DEPENDS ${image}.elf)
endfunction()

# --- the USB bridge, and the examples -------------------------------------------------------------------

add_custom_target(arduino_images)
file(GLOB sketches CONFIGURE_DEPENDS ${roio_arduino_dir}/examples/*/*.ino
     ${PROJECT_SOURCE_DIR}/bridge_usb/bridge_usb.ino)
foreach(sketch IN LISTS sketches)
  cmake_path(GET sketch STEM name)
  foreach(board IN LISTS ROIO_BOARDS)
    add_arduino_image(image_${board}_${name} ${board} ${sketch})
    add_dependencies(arduino_images image_${board}_${name})
  endforeach()
endforeach()
