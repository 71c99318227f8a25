# Warnings are for those who work on Roio (the presets switch them on), never for those who use it.
add_library(roio_warnings INTERFACE)
if(ROIO_WARNINGS)
  target_compile_options(roio_warnings INTERFACE
    -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion -Wshadow -Wold-style-cast
    -Wnon-virtual-dtor -Woverloaded-virtual -Wimplicit-fallthrough -Wformat=2 -Werror)
endif()
