#include "engine/render/passes/overlay_pass.h"

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "engine/scene/streaming/light.h"
#include "engine/view/facade_view.h"
#include "engine/view/grain_view.h"

namespace reljef::render {
namespace {

// Metres along the turned axes per unit of a search space.
glm::dmat3 metres_per_unit(const view::GrainView& view, const scene::TerrainNode& terrain,
                           const glm::dmat4& world_from_local, const ReliefSpace& space) {
    const bool is_curved = terrain.surface->placement().kind() == terrain::PlacementKind::ellipsoid;
    const glm::dmat3 on_plane = glm::dmat3(world_from_local) * glm::inverse(space.space_from_local);
    glm::dmat3 metres(1.0);
    for (int axis = 0; axis < 3; ++axis) {
        metres[axis] = is_curved ? view.metres_per_sample[axis] * space.samples_per_unit[axis]
                                 : view::turned(on_plane[axis]);
    }
    return metres;
}

// `metres`: per unit of a relief's search space.
OverlayBlock overlay_block(const view::DrawList& list, const view::GrainView& view,
                           const glm::dmat3& metres) {
    return {.grain_pattern_0 = view.patterns[0],
            .grain_pattern_1 = view.patterns[1],
            .grain_pattern_2 = view.patterns[2],
            .grain_up = glm::vec4(view.up, view.strength),
            .grain_sun = list.sun ? glm::vec4(view::turned(scene::to_light(*list.sun)), 0.0)
                                  : glm::vec4(0.0F),
            .grain_turn = glm::vec4(view::GrainView::turn, view.pattern_count, view.radius),
            .grain_light = glm::vec4(1.0F / view.level_light, 0.0F),
            .contours = glm::vec4(0.0F),
            .facade_sun = glm::vec4(0.0F),
            .facade_sky = glm::vec4(0.0F),
            .grain_normal_from_slopes = glm::mat4(glm::mat3(glm::transpose(glm::inverse(metres))))};
}

} // namespace

ShaderFeatures overlay_features(const FrameContext& frame, const scene::TerrainNode& terrain,
                                double distance) {
    if (frame.hits || frame.counts() || terrain.material.wireframe) {
        return 0;
    }
    if (view::shows_facades(terrain)) {
        return feature_overlay | feature_facades;
    }
    const bool has_overlay =
        view::shows_grain(frame.list, terrain, distance) || scene::shown_contours(terrain) > 0.0;
    return has_overlay ? feature_overlay : 0U;
}

Result<void> set_overlay(const FrameContext& frame, const scene::TerrainNode& terrain,
                         const glm::dmat4& world_from_local, const ReliefSpace* space) {
    if (overlay_features(frame, terrain) == 0) {
        return {};
    }
    if (scene::shown_grain(terrain) > 0.0F) {
        frame.residency.grain().bind();
        ++frame.state.stats().state_changes;
    }
    const view::GrainView view = view::grain_view(frame.list, terrain, world_from_local);
    const glm::dmat3 metres = space != nullptr
                                  ? metres_per_unit(view, terrain, world_from_local, *space)
                                  : glm::dmat3(1.0);
    OverlayBlock block = overlay_block(frame.list, view, metres);
    block.contours = {scene::shown_contours(terrain), terrain.surface->placement().exaggeration(),
                      view::contour_scale(frame.list.camera, frame.list.size), 0.0};
    if (view::shows_facades(terrain)) {
        const ResidentFacades& facades = frame.residency.facades().bind(terrain);
        ++frame.state.stats().state_changes;
        block.facade_sun = glm::vec4(facades.sun, 0.0F);
        block.facade_sky = glm::vec4(facades.sky, 0.0F);
    }
    return frame.state.set(block);
}

} // namespace reljef::render
