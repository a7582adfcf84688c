#include "engine/render/passes/sky_painter.h"

namespace reljef::render {
Result<void> paint_sky(const Painting& painting) {
    if (!painting.list.sky || painting.hits) {
        return {};
    }
    DrawState& state = painting.state;
    auto program = state.use({ShaderKind::sky, painting.features});
    if (!program) {
        return program.error();
    }
    state.set_culling(gl::Culling::back);
    state.set_wireframe(false);
    gl::set_depth_writing(false);
    gl::set_depth_test(gl::DepthTest::greater_or_equal);
    painting.no_vertices.bind();
    gl::draw_arrays(gl::Primitive::triangles, 0, 3);
    gl::set_depth_writing(true);
    gl::set_depth_test(gl::DepthTest::greater);
    state.stats().state_changes += 5;
    ++state.stats().draws;
    return {};
}

} // namespace reljef::render
