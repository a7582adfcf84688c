#pragma once

#include <cstdlib>
#include <string_view>

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

/// How often a property is tested by default, and with `./dev test full`, which sets RELJEF_TESTS.
inline int cases(int by_default, int in_full) {
    const char* const chosen = std::getenv("RELJEF_TESTS");
    return chosen != nullptr && std::string_view(chosen) == "full" ? in_full : by_default;
}

} // namespace reljef::test
