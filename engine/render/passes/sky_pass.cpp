#include "engine/render/passes/sky_pass.h"

namespace reljef::render {
Result<void> paint_sky(const FrameContext& frame_context) {
    if (!frame_context.list.sky || frame_context.hits) {
        return {};
    }
    DrawState& state = frame_context.state;
    auto program = state.use({ShaderKind::sky, frame_context.features});
    if (!program) {
        return program.error();
    }
    state.set_culling(gl::Culling::back);
    state.set_wireframe(false);
    gl::set_depth_writing(false);
    gl::set_depth_test(gl::DepthTest::greater_or_equal);
    frame_context.no_vertices.bind();
    gl::draw_arrays(gl::Primitive::triangles, 3);
    gl::set_depth_writing(true);
    gl::set_depth_test(gl::DepthTest::greater);
    state.stats().state_changes += 5;
    ++state.stats().draws;
    return {};
}

} // namespace reljef::render
