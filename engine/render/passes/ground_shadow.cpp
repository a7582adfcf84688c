#include "engine/render/passes/ground_shadow.h"

#include <algorithm>

#include <glm/matrix.hpp>

#include "engine/render/residency/uploads.h"
#include "engine/render/shaders/sun_maps.h"
#include "engine/terrain/light/sun_visibility.h"

namespace reljef::render {
namespace {

const view::TerrainDraw* shadowing_ground(const view::DrawList& list) {
    const auto found =
        std::find_if(list.terrains.begin(), list.terrains.end(), [](const view::TerrainDraw& draw) {
            return casts_shadows(draw) &&
                   draw.terrain->surface->placement().kind() == terrain::PlacementKind::plane;
        });
    return found == list.terrains.end() ? nullptr : &*found;
}

// Between the samples of the texture.
int step_between(const scene::TerrainSurface& surface, int max_side) {
    const Grid<float>& heights = surface.heightfield().heights;
    return (std::max(heights.cols(), heights.rows()) - 1) / max_side + 1;
}

// No lower than all ground, so that they can be interpolated.
Grid<float> edge_heights(const scene::TerrainSurface& surface, const scene::TerrainLight& light,
                         int step) {
    const terrain::Heightfield& field = surface.heightfield();
    const glm::dvec3 to_sun =
        glm::inverse(light.world_from_local) * scene::to_light(light.sun); // rows go south
    const Grid<float> all = terrain::shadow_heights(field.heights.view(), field.spacing,
                                                    surface.placement().exaggeration(), to_sun);
    const float lowest = surface.pyramid().total().low;
    Grid<float> edges((all.cols() + step - 1) / step, (all.rows() + step - 1) / step);
    for (int row = 0; row < edges.rows(); ++row) {
        for (int col = 0; col < edges.cols(); ++col) {
            edges(col, row) = std::max(all(step * col, step * row), lowest);
        }
    }
    return edges;
}

// To texture coordinates and true heights. `texels`: of the texture, with `step` samples between
// them.
glm::mat4 place_matrix(const view::TerrainDraw& draw, glm::dvec3 eye, glm::ivec2 texels,
                       double step) {
    const terrain::Placement& placement = draw.terrain->surface->placement();
    const glm::dmat4 local_from_world = glm::inverse(draw.world_from_local);
    const auto place = [&](glm::dvec3 relative) {
        const glm::dvec3 local(local_from_world * glm::dvec4(eye + relative, 1.0));
        const glm::dvec3 sample = placement.sample_from_world(local).value();
        return glm::dvec3((glm::dvec2(sample) / step + 0.5) / glm::dvec2(texels), sample.z);
    };
    const glm::dvec3 origin = place(glm::dvec3(0.0));
    return glm::mat4(glm::dmat4(glm::dvec4(place({1.0, 0.0, 0.0}) - origin, 0.0),
                                glm::dvec4(place({0.0, 1.0, 0.0}) - origin, 0.0),
                                glm::dvec4(place({0.0, 0.0, 1.0}) - origin, 0.0),
                                glm::dvec4(origin, 1.0)));
}

} // namespace

Result<void> GroundShadow::prepare(const view::DrawList& list, int max_side,
                                   view::FrameStats& stats) {
    place_from_relative_.reset();
    const view::TerrainDraw* const draw = shadowing_ground(list);
    if (draw == nullptr) {
        return {};
    }
    const std::shared_ptr<const scene::TerrainSurface>& surface = draw->terrain->surface;
    const auto light = view::light_on(list, draw->world_from_local);
    const int step = step_between(*surface, max_side);
    if (owner_.lock() == surface && light_ == light) {
        ++stats.skipped.uploads_unchanged;
    } else {
        auto texture =
            upload_grid(edge_heights(*surface, *light, step), {.format = gl::Format::r32f}, stats);
        if (!texture) {
            return texture.error();
        }
        heights_ = std::move(*texture);
        owner_ = surface;
        light_ = light;
    }
    place_from_relative_ = place_matrix(*draw, list.camera.eye, heights_.size(), step);
    return {};
}

void GroundShadow::bind(MeshShadowBlock& block) const {
    if (place_from_relative_) {
        heights_.bind(bindings::ground_shadow_unit);
        block.mesh_shadow_numbers.y = 1.0F;
        block.ground_shadow_place = *place_from_relative_;
    }
}

} // namespace reljef::render
