#pragma once

#include <gtest/gtest.h>

/// Skips the test, with the reason, under AddressSanitizer: for what asks much time of whole
/// programs whose every part has sanitized tests of its own.
#ifdef __SANITIZE_ADDRESS__
#define RELJEF_RELEASE_ONLY(reason) GTEST_SKIP() << "only the release: " << (reason)
#else
#define RELJEF_RELEASE_ONLY(reason) static_cast<void>(0)
#endif
