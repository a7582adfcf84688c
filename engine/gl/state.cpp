#include "engine/gl/state.h"

#include <glad/gl.h>

namespace reljef::gl {

namespace {

void enable(GLenum capability, bool on) {
    if (on) {
        glEnable(capability);
    } else {
        glDisable(capability);
    }
}

} // namespace

void set_reversed_depth() {
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glDepthRangef(0.0F, 1.0F);
    glClearDepthf(0.0F);
    set_depth_test(DepthTest::greater);
    set_depth_writing(true);
}

void set_depth_test(DepthTest test) {
    enable(GL_DEPTH_TEST, test != DepthTest::off);
    glDepthFunc(test == DepthTest::always             ? GL_ALWAYS
                : test == DepthTest::greater_or_equal ? GL_GEQUAL
                                                      : GL_GREATER);
}

void set_depth_writing(bool on) {
    glDepthMask(on ? GL_TRUE : GL_FALSE);
}

void set_culling(Culling culling) {
    glFrontFace(GL_CCW);
    glCullFace(culling == Culling::front ? GL_FRONT : GL_BACK);
    enable(GL_CULL_FACE, culling != Culling::none);
}

void set_polygon_mode(PolygonMode mode) {
    glPolygonMode(GL_FRONT_AND_BACK, mode == PolygonMode::line ? GL_LINE : GL_FILL);
}

void set_sample_shading(bool on) {
    enable(GL_SAMPLE_SHADING, on);
    glMinSampleShading(on ? 1.0F : 0.0F);
}

void set_adding(bool on) {
    enable(GL_BLEND, on);
    glBlendFunc(GL_ONE, GL_ONE);
}

} // namespace reljef::gl
