#include "engine/render/passes/frame_context.h"
#include "engine/render/shaders/uniforms.h"

namespace reljef::render {

Result<void> draw_sky(const FrameContext& frame) {
    if (!frame.list.sky || frame.hits) {
        return {};
    }
    DrawState& state = frame.state;
    auto program = state.use({ShaderKind::sky, frame.features});
    if (!program) {
        return program.error();
    }
    state.set_culling(gl::Culling::back);
    state.set_wireframe(false);
    gl::set_depth_writing(false);
    gl::set_depth_test(gl::DepthTest::greater_or_equal);
    const SkyResidency& sky = frame.residency.sky();
    sky.bind();
    (*program)->set(uniforms.sky_side, static_cast<float>(sky.side()));
    if (frame.list.sky_picture) {
        (*program)->set(uniforms.picture_from_world,
                        glm::mat3(frame.list.sky_picture->picture_from_world));
    }
    frame.no_vertices.bind();
    gl::draw_arrays(gl::Primitive::triangles, 3);
    gl::set_depth_writing(true);
    gl::set_depth_test(gl::DepthTest::greater);
    state.stats().state_changes += 5;
    ++state.stats().draws;
    return {};
}

} // namespace reljef::render
