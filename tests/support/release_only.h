#pragma once

#include <gtest/gtest.h>

/// Skips the test, with the reason, under AddressSanitizer: for what asks much time of whole
/// programs whose every part has sanitized tests of its own.
#ifdef __SANITIZE_ADDRESS__
#define RELJEF_RELEASE_ONLY(reason) GTEST_SKIP() << "only the release: " << (reason)
#else
#define RELJEF_RELEASE_ONLY(reason) static_cast<void>(0)
#endif

namespace reljef::test {

/// How often a property is tested: seldom under AddressSanitizer, where each case shows the same
/// errors of memory.
constexpr int rounds(int in_release, int sanitized) {
#ifdef __SANITIZE_ADDRESS__
    static_cast<void>(in_release);
    return sanitized;
#else
    static_cast<void>(sanitized);
    return in_release;
#endif
}

} // namespace reljef::test
