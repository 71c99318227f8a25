/// ROIO_EXPORT marks what programs may call of libroio.so; all else in it is hidden. In a static
/// library it is nothing: a program, or a library of yours that takes libroio.a in, exports nothing
/// of Roio's. Who builds against the shared library is told so by -D ROIO_SHARED, which CMake's
/// target and roio.pc bring along.
#ifndef ROIO_EXPORT_HPP
#define ROIO_EXPORT_HPP

#if defined(ROIO_SHARED) && defined(__GNUC__)
#define ROIO_EXPORT __attribute__((visibility("default")))
#else
#define ROIO_EXPORT
#endif

#endif
