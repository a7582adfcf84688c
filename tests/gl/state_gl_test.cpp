#include "engine/gl/state.h"

#include <random>
#include <utility>

#include <glad/gl.h>
#include <gmock/gmock.h>

#include "engine/gl/read_pixels.h"
#include "tests/gl/gl_fixture.h"

namespace reljef::gl {
namespace {

using StateGlTest = test::GlTest;

int covered(const Framebuffer& framebuffer) {
    int count = 0;
    const Grid<glm::vec4> pixels = read_float_color(framebuffer);
    for (const glm::vec4& pixel : pixels.samples()) {
        count += pixel.r > 0.0F ? 1 : 0;
    }
    return count;
}

class Painter {
public:
    explicit Painter(const std::string& place = "corner * 4.0 - 1.0")
        : program_(
              test::cover_program("uniform vec4 paint;\nvoid main() { color = paint; }", place)) {}

    void draw(float depth, float paint) {
        program_.set(Uniform<float>("depth"), depth);
        program_.set(Uniform<glm::vec4>("paint"), glm::vec4(paint, paint, paint, 0.5F));
        test::cover(program_);
    }

private:
    Program program_;
};

TEST_F(StateGlTest, the_nearer_surface_wins_in_either_order) {
    const Framebuffer framebuffer = test::float_target({2, 2});
    Painter painter;
    set_reversed_depth();
    framebuffer.bind();
    std::mt19937 generator(21);
    std::uniform_real_distribution<float> exponent(-30.0F, 0.0F);
    for (int pair = 0; pair < 500; ++pair) {
        const float far_depth = std::exp2(exponent(generator));
        const float near_depth = std::nextafter(far_depth, 2.0F);
        const bool near_first = pair % 2 == 0;
        framebuffer.clear_depth();
        painter.draw(near_first ? near_depth : far_depth, near_first ? 1.0F : 2.0F);
        painter.draw(near_first ? far_depth : near_depth, near_first ? 2.0F : 1.0F);
        ASSERT_EQ(read_float_color(framebuffer)(0, 0).r, 1.0F) << far_depth;
        ASSERT_EQ(test::read_depth(framebuffer)(0, 0), near_depth);
    }
}

TEST_F(StateGlTest, the_sky_at_depth_0_needs_or_equal) {
    const Framebuffer framebuffer = test::float_target({2, 2});
    Painter painter;
    set_reversed_depth();
    framebuffer.bind();
    framebuffer.clear_depth();
    framebuffer.clear_color(glm::vec4(0.0F));
    painter.draw(0.0F, 1.0F);
    EXPECT_EQ(covered(framebuffer), 0);
    set_depth_test(DepthTest::greater_or_equal);
    painter.draw(0.0F, 1.0F);
    EXPECT_EQ(covered(framebuffer), 4);
}

TEST_F(StateGlTest, depth_is_untouched_without_writing_and_without_test) {
    const Framebuffer framebuffer = test::float_target({2, 2});
    Painter painter;
    set_reversed_depth();
    framebuffer.bind();
    framebuffer.clear_depth();
    set_depth_writing(false);
    painter.draw(0.5F, 1.0F);
    EXPECT_EQ(test::read_depth(framebuffer)(0, 0), 0.0F);
    set_depth_writing(true);
    set_depth_test(DepthTest::off);
    painter.draw(0.5F, 1.0F);
    EXPECT_EQ(test::read_depth(framebuffer)(0, 0), 0.0F);
    set_depth_test(DepthTest::greater);
    painter.draw(0.5F, 1.0F);
    EXPECT_EQ(test::read_depth(framebuffer)(0, 0), 0.5F);
}

TEST_F(StateGlTest, culling_takes_the_named_side_of_a_counter_clockwise_triangle) {
    const Framebuffer framebuffer = test::float_target({4, 4});
    Painter painter;
    set_depth_test(DepthTest::off);
    framebuffer.bind();
    for (const auto& [culling, pixels] :
         {std::pair(Culling::none, 16), std::pair(Culling::back, 16),
          std::pair(Culling::front, 0)}) {
        framebuffer.clear_color(glm::vec4(0.0F));
        set_culling(culling);
        painter.draw(0.5F, 1.0F);
        EXPECT_EQ(covered(framebuffer), pixels);
    }
}

TEST_F(StateGlTest, lines_leave_the_inside_empty) {
    const Framebuffer framebuffer = test::float_target({64, 64});
    // Away from the border, where drivers may clip lines.
    Painter painter("corner - 0.5");
    framebuffer.bind();
    framebuffer.clear_color(glm::vec4(0.0F));
    glViewport(0, 0, 64, 64);
    set_polygon_mode(PolygonMode::line);
    painter.draw(0.5F, 1.0F);
    EXPECT_NEAR(covered(framebuffer), 3 * 32, 6);
    set_polygon_mode(PolygonMode::fill);
    framebuffer.clear_color(glm::vec4(0.0F));
    painter.draw(0.5F, 1.0F);
    EXPECT_NEAR(covered(framebuffer), 32 * 32 / 2, 16); // pixels on the slanted edge
}

} // namespace
} // namespace reljef::gl
