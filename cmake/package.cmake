# Debian packages, which scripts/package makes: roio (the tools and what goes with them) and
# libroio-dev (headers and the static library, for CMake and pkg-config).
#
# The library is static there: before 1.0 each minor version is another one to link, and a program
# that has taken it in runs on when the package is another. Who wants libroio.so builds with
# BUILD_SHARED_LIBS.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME roio)
set(CPACK_PACKAGE_VENDOR Roio)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "robot's nervous system on CAN, from microcontroller to PC")
set(CPACK_PACKAGE_CONTACT "Roio maintainers <noreply@roio.invalid>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL development)
if(ROIO_BUILD_TOOLS)
  list(APPEND CPACK_COMPONENTS_ALL tools)
endif()
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_STRIP_FILES ON)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/debian_files.cmake)
set(CPACK_ROIO_SOURCE_DIR ${PROJECT_SOURCE_DIR})

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SOURCE roio)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME roio)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION electronics)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SUGGESTS
    "can-utils, arduino-builder, arduino-ctags, arduino-core-avr, avr-libc, gcc-avr, python3")
set(CPACK_DEBIAN_TOOLS_DESCRIPTION
"This package has the command line and the simulator.
.
roio-cli shows and sends messages on a CAN bus, a bus between the programs of
one machine, or through an Arduino as a bridge. roio-sim runs the firmware of
Arduino boards, unchanged, on a simulated bus.
.
In /usr/share/roio are the Arduino library as a zip, and kinds of boards for
robot files. To build sketches, roio-sim needs the suggested packages.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libroio-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "roio, cmake, pkgconf")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION
"This package has the C++20 library to develop with.
.
Short addressed messages over SocketCAN, a bus between the programs of one
machine, or an Arduino as a bridge. Headers and the static library, to be
found by CMake and pkg-config.")

include(CPack)
