#include "engine/platform/egl_library.h"

#include <gtest/gtest.h>

namespace reljef::platform {
namespace {

TEST(EglLibraryTest, an_extension_is_a_whole_word) {
    constexpr const char* list = "EGL_EXT_device_base EGL_EXT_platform_device EGL_MESA_drm";
    EXPECT_TRUE(has_extension(list, "EGL_EXT_device_base"));
    EXPECT_TRUE(has_extension(list, "EGL_EXT_platform_device"));
    EXPECT_TRUE(has_extension(list, "EGL_MESA_drm"));
    EXPECT_FALSE(has_extension(list, "EGL_EXT_device"));
    EXPECT_FALSE(has_extension(list, "EGL_MESA_drm_image"));
    EXPECT_FALSE(has_extension("", "EGL_MESA_drm"));
    EXPECT_FALSE(has_extension(nullptr, "EGL_MESA_drm"));
}

TEST(EglLibraryTest, hardware_comes_first) {
    const auto egl = open_egl();
    if (!egl) {
        GTEST_SKIP() << egl.error().message;
    }
    bool software_seen = false;
    for (const EglCandidate& candidate : egl_candidates(*egl)) {
        EXPECT_NE(candidate.display, EGL_NO_DISPLAY);
        EXPECT_FALSE(candidate.hardware && software_seen);
        software_seen = software_seen || !candidate.hardware;
    }
}

} // namespace
} // namespace reljef::platform
