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
    EXPECT_GE(limits.max_texture_layers, 2048);
    EXPECT_GE(limits.max_texture_units, 96);
    EXPECT_GE(limits.max_fragment_texture_units, 16);
    EXPECT_GE(limits.max_color_attachments, 8);
    EXPECT_GE(limits.max_samples, 4);
    EXPECT_GE(limits.max_viewport.x, 1024);
    EXPECT_GE(limits.max_viewport.y, 1024);
    EXPECT_GE(limits.max_uniform_block_bytes, 16384U);
    EXPECT_GE(limits.max_storage_block_bytes, std::size_t{1} << 27U);
    EXPECT_GE(limits.uniform_block_alignment, 1U);
    EXPECT_LE(limits.uniform_block_alignment, 256U);
    EXPECT_GE(limits.max_tessellation_level, 64);
}

TEST_F(LimitsGlTest, the_driver_has_a_name) {
    const Limits limits = query_limits();
    EXPECT_THAT(limits.version, ::testing::StartsWith("4."));
    EXPECT_THAT(limits.glsl_version, ::testing::StartsWith("4."));
    EXPECT_FALSE(limits.renderer.empty());
    EXPECT_FALSE(limits.vendor.empty());
}

} // namespace
} // namespace reljef::gl
