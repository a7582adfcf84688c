#include "engine/gl/limits.h"

#include <gmock/gmock.h>

#include "tests/gl/gl_fixture.h"

namespace reljef::gl {
namespace {

using LimitsGlTest = test::GlTest;

// The minima of the OpenGL 4.5 core specification, tables 23.53 and following.
TEST_F(LimitsGlTest, at_least_what_the_specification_demands) {
    const Limits limits = query_limits();
    EXPECT_GE(limits.max_texture_size, 16384);
    EXPECT_GE(limits.max_texture_units, 96);
    EXPECT_GE(limits.max_fragment_texture_units, 16);
    EXPECT_GE(limits.max_viewport.x, 1024);
    EXPECT_GE(limits.max_viewport.y, 1024);
    EXPECT_THAT(limits.version, ::testing::StartsWith("4."));
    EXPECT_FALSE(limits.renderer.empty());
}

} // namespace
} // namespace reljef::gl
