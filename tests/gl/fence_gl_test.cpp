#include "engine/gl/fence.h"

#include <utility>

#include <glad/gl.h>

#include "tests/gl/gl_fixture.h"

namespace reljef::gl {
namespace {

using FenceGlTest = test::GlTest;

TEST_F(FenceGlTest, work_before_it_is_done_after_waiting) {
    const Framebuffer target = test::float_target({512, 512});
    const Program program =
        test::cover_program("void main() { color = sin(gl_FragCoord.xyxy) * 0.5; }");
    target.bind();
    GLuint query = 0;
    glCreateQueries(GL_SAMPLES_PASSED, 1, &query);
    glBeginQuery(GL_SAMPLES_PASSED, query);
    test::cover(program);
    glEndQuery(GL_SAMPLES_PASSED);
    Fence::after_commands().wait();
    GLint is_done = GL_FALSE;
    glGetQueryObjectiv(query, GL_QUERY_RESULT_AVAILABLE, &is_done);
    EXPECT_EQ(is_done, GL_TRUE);
    glDeleteQueries(1, &query);
}

TEST_F(FenceGlTest, default_and_moved_ones_are_passed) {
    Fence().wait();
    Fence fence = Fence::after_commands();
    const Fence other = std::move(fence);
    other.wait();
    fence = Fence();
    fence.wait();
}

} // namespace
} // namespace reljef::gl
