/// The one place that holds the version number. CMake, the Arduino library and --version read it.
#ifndef ROIO_VERSION_HPP
#define ROIO_VERSION_HPP

#define ROIO_VERSION_MAJOR 0
#define ROIO_VERSION_MINOR 1
#define ROIO_VERSION_PATCH 0

#define ROIO_VERSION_TEXT_(major, minor, patch) #major "." #minor "." #patch
#define ROIO_VERSION_TEXT(major, minor, patch) ROIO_VERSION_TEXT_(major, minor, patch)

/// "MAJOR.MINOR.PATCH".
#define ROIO_VERSION ROIO_VERSION_TEXT(ROIO_VERSION_MAJOR, ROIO_VERSION_MINOR, ROIO_VERSION_PATCH)

#endif
