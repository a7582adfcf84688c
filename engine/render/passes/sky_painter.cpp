#include "engine/render/passes/sky_painter.h"

namespace reljef::render {
namespace {

void set_corner_rays(gl::Program& program, const view::DrawList& list) {
    const auto direction_at = [&](glm::dvec2 pixel) {
        return scene::view_ray(list.camera, list.size, pixel).direction;
    };
    const glm::dvec2 extent(list.size);
    const glm::dvec3 corner = direction_at({0.0, extent.y});
    const glm::dvec3 right = direction_at(extent);
    const glm::dvec3 up = direction_at({0.0, 0.0});
    program.set_uniform("ray_corner", glm::vec4(glm::vec3(corner), 0.0F));
    program.set_uniform("ray_right", glm::vec4(glm::vec3(right - corner), 0.0F));
    program.set_uniform("ray_up", glm::vec4(glm::vec3(up - corner), 0.0F));
}

} // namespace

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
    set_corner_rays(**program, painting.list);
    painting.no_vertices.bind();
    gl::draw_arrays(gl::Primitive::triangles, 0, 3);
    gl::set_depth_writing(true);
    gl::set_depth_test(gl::DepthTest::greater);
    state.stats().state_changes += 5;
    ++state.stats().draws;
    return {};
}

} // namespace reljef::render
