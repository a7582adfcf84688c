#include "tests/gl/gl_fixture.h"

#include <array>

#include <gmock/gmock.h>

#include "engine/gl/draw.h"
#include "tests/support/test_context.h"

namespace reljef::test {

void GlTest::SetUp() {
    const auto kind = platform::context_kind_from_string(context_name());
    ASSERT_TRUE(kind) << "RELJEF_TEST_CONTEXT is " << context_name();
    auto made = platform::make_context(*kind, {.debug = true, .visible = false});
    ASSERT_TRUE(made) << made.error().message;
    context_ = std::move(*made);
    log_.emplace();
}

void GlTest::TearDown() {
    if (log_) {
        EXPECT_THAT(log_->problems(), ::testing::IsEmpty());
    }
    log_.reset();
    context_.reset();
}

std::vector<std::string> GlTest::take_problems() {
    auto problems = log_->problems();
    log_->clear();
    return problems;
}

gl::Framebuffer float_target(glm::ivec2 size) {
    return must(gl::Framebuffer::create({.size = size, .colors = {gl::Format::rgba32f}}));
}

gl::Program cover_program(const std::string& fragment_body) {
    const std::string vertex = "#version 450 core\n"
                               "uniform float depth;\n"
                               "void main() {\n"
                               "    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);\n"
                               "    gl_Position = vec4(corner * 4.0 - 1.0, depth, 1.0);\n"
                               "}\n";
    const std::string fragment =
        "#version 450 core\nlayout(location = 0) out vec4 color;\n" + fragment_body;
    const std::array stages{
        gl::StageSource{.stage = gl::Stage::vertex, .name = "cover.vert", .text = vertex},
        gl::StageSource{.stage = gl::Stage::fragment, .name = "cover.frag", .text = fragment}};
    return must(gl::Program::create(stages));
}

void cover(const gl::Program& program) {
    const gl::VertexArray none = gl::VertexArray::create();
    none.bind();
    program.use();
    gl::draw_arrays(gl::Primitive::triangles, 0, 3);
}

} // namespace reljef::test
