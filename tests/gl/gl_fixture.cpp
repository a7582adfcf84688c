#include "tests/gl/gl_fixture.h"

#include <array>

#include <glad/gl.h>
#include <gmock/gmock.h>

#include "engine/gl/draw.h"
#include "tests/support/test_context.h"

namespace reljef::test {

namespace {

void GLAD_API_PTR collect(GLenum /*source*/, GLenum type, GLuint /*id*/, GLenum severity,
                          GLsizei /*length*/, const GLchar* text, const void* user) {
    // Drivers of hardware tell at medium severity when they compile a program once more.
    const bool is_severe =
        severity == GL_DEBUG_SEVERITY_HIGH ||
        (severity == GL_DEBUG_SEVERITY_MEDIUM && type != GL_DEBUG_TYPE_PERFORMANCE);
    if (type == GL_DEBUG_TYPE_ERROR || is_severe) {
        static_cast<std::vector<std::string>*>(const_cast<void*>(user))->emplace_back(text);
    }
}

} // namespace

DebugLog::DebugLog() {
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_TRUE);
    glDebugMessageCallback(collect, &problems_);
}

DebugLog::~DebugLog() {
    glDebugMessageCallback(nullptr, nullptr);
}

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

Grid<float> read_depth(const gl::Framebuffer& framebuffer) {
    const glm::ivec2 size = framebuffer.size();
    Grid<float> depth(size.x, size.y);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer.id());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    for (int row = 0; row < size.y; ++row) {
        glReadPixels(0, size.y - 1 - row, size.x, 1, GL_DEPTH_COMPONENT, GL_FLOAT,
                     depth.row(row).data());
    }
    return depth;
}

gl::Framebuffer float_target(glm::ivec2 size) {
    return must(gl::Framebuffer::create({.size = size, .color = gl::Format::rgba32f}));
}

gl::Program cover_program(const std::string& fragment_body, const std::string& place) {
    const std::string vertex = "#version 450 core\n"
                               "uniform float depth;\n"
                               "void main() {\n"
                               "    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);\n"
                               "    gl_Position = vec4(" +
                               place +
                               ", depth, 1.0);\n"
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
    gl::draw_arrays(gl::Primitive::triangles, 3);
}

} // namespace reljef::test
