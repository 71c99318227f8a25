#ifndef ROIO_TESTS_SANITIZERS_HPP
#define ROIO_TESTS_SANITIZERS_HPP

namespace roio::test {

/// Whether this code is instrumented by AddressSanitizer or ThreadSanitizer: ten times slower, so
/// that a test of many rounds takes fewer. GCC says so by a macro, clang by a feature.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool is_instrumented = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
inline constexpr bool is_instrumented = true;
#else
inline constexpr bool is_instrumented = false;
#endif
#else
inline constexpr bool is_instrumented = false;
#endif

}  // namespace roio::test

#endif
