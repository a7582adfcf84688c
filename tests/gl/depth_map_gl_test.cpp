#include "engine/gl/depth_map.h"

#include "engine/gl/limits.h"
#include "engine/gl/read_pixels.h"
#include "engine/gl/state.h"
#include "tests/gl/gl_fixture.h"

namespace reljef::gl {
namespace {

using test::must;
using DepthMapGlTest = test::GlTest;

TEST_F(DepthMapGlTest, compares_with_what_was_drawn_into_a_square_of_it) {
    const DepthMap map = must(DepthMap::create(8));
    Program draws = test::cover_program("void main() { color = vec4(1.0); }");
    Program compares = test::cover_program(
        "layout(binding = 3) uniform sampler2DShadow map;\n"
        "void main() { color = vec4(texture(map, vec3(gl_FragCoord.xy / 8.0, 0.5))); }");
    set_reversed_depth();
    map.clear();
    map.bind({4, 0}, 4);
    draws.set(Uniform<float>("depth"), 0.6F);
    test::cover(draws);
    const Framebuffer target = test::float_target({8, 8});
    target.bind();
    target.clear_depth();
    map.bind_texture(3);
    compares.set(Uniform<float>("depth"), 0.9F);
    test::cover(compares);
    const Grid<glm::vec4> pixels = read_float_color(target); // row 0 at the top
    EXPECT_EQ(pixels(6, 5).r, 0.0F) << "0.5 is behind 0.6";
    EXPECT_EQ(pixels(1, 5).r, 1.0F) << "beside the square";
    EXPECT_EQ(pixels(6, 1).r, 1.0F) << "above it";
}

TEST_F(DepthMapGlTest, sides_that_gl_cannot_draw_are_errors) {
    EXPECT_FALSE(DepthMap::create(0));
    EXPECT_FALSE(DepthMap::create(query_limits().max_texture_size + 1));
    EXPECT_EQ(DepthMap().side(), 0);
}

} // namespace
} // namespace reljef::gl
