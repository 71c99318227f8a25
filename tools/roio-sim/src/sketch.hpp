/// Sketches in place of images: X/X.ino, or its folder, is built before the boards start.
///
/// arduino_image.py does it, with the Arduino library beside it. Both lie in share/roio, next to
/// the folder that this program is in: in an installed tree and in a build tree alike.
///
///   PREFIX/bin/roio-sim
///   PREFIX/share/roio/arduino_image.py
///   PREFIX/share/roio/Roio-VERSION.zip
#ifndef ROIO_SIM_TOOL_SKETCH_HPP
#define ROIO_SIM_TOOL_SKETCH_HPP

#include <string>
#include <vector>

#include "options.hpp"

namespace roio::sim_tool {

/// Whether it is a sketch's name (.ino) or a folder: what is no image.
bool is_sketch(const std::string& path);

/// Replaces every sketch by the image that was made of it. catch_signals() comes before: a signal
/// ends the build.
/// @return 0, or the exit status to end with when one could not be built; what was wrong is told.
/// @throws cli::Failure: no python3, or share/roio is not there.
int build_sketches(std::vector<BoardWish>& boards);

}  // namespace roio::sim_tool

#endif
