#include "engine/render/passes/frame_context.h"
#include "engine/render/shaders/uniforms.h"

namespace reljef::render {

Result<void> draw_sky(const FrameContext& frame) {
    if (!frame.list.sky || frame.hits) {
        return {};
    }
    DrawState& state = frame.state;
    const SkyResidency& sky = frame.residency.sky();
    const ShaderFeatures picture = sky.side() > 0 ? feature_sky_picture : 0U;
    auto program = state.use({ShaderKind::sky, frame.features | picture});
    if (!program) {
        return program.error();
    }
    state.set_culling(gl::Culling::back);
    state.set_wireframe(false);
    gl::set_depth_writing(false);
    gl::set_depth_test(gl::DepthTest::greater_or_equal);
    sky.bind();
    if (picture != 0) {
        (*program)->set(uniforms.sky_side, static_cast<float>(sky.side()));
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
