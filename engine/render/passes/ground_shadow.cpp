#include "engine/render/passes/ground_shadow.h"

#include <algorithm>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/render/residency/uploads.h"
#include "engine/render/shaders/bindings.h"
#include "engine/render/shaders/sun_maps.h"
#include "engine/scene/streaming/tile_stream.h"
#include "engine/terrain/field/gradient.h"
#include "engine/terrain/light/sun_visibility.h"

namespace reljef::render {
namespace {

constexpr float highest = 1e6F; // metres: instead of infinity, so that heights can be interpolated

glm::dvec3 sun_on_grid(const scene::TerrainSurface& surface, const scene::TerrainLight& light) {
    const Grid<float>& heights = surface.heightfield().heights;
    const glm::dvec2 middle = 0.5 * glm::dvec2(heights.cols() - 1, heights.rows() - 1);
    return glm::inverse(light.world_from_local) * scene::to_light(light.sun) *
           terrain::grid_axes(surface.heightfield(), surface.placement(), middle);
}

// Of every `step`-th sample.
Grid<glm::vec2> shadow_texels(const scene::TerrainSurface& surface,
                              const scene::TerrainLight& light, int step) {
    const terrain::Heightfield& field = surface.heightfield();
    const Grid<float> edges =
        terrain::shadow_heights(field.heights.view(), field.spacing,
                                surface.placement().exaggeration(), sun_on_grid(surface, light));
    const float lowest = surface.pyramid().total().low - 1.0F;
    Grid<glm::vec2> texels((edges.cols() - 1) / step + 1, (edges.rows() - 1) / step + 1);
    for (int row = 0; row < texels.rows(); ++row) {
        for (int col = 0; col < texels.cols(); ++col) {
            const float edge = std::clamp(edges(step * col, step * row), lowest, highest);
            texels(col, row) = {edge, field.heights(step * col, step * row)};
        }
    }
    return texels;
}

bool has_triangles(const view::DrawList& list, const view::TerrainDraw& draw) {
    return std::any_of(list.tiles.begin(), list.tiles.end(),
                       [&](const view::TileDraw& tile) { return tile.terrain == draw.terrain; });
}

// Of the overview, or of the terrain in memory.
glm::dvec2 on_surface(const view::TileDraw& draw, glm::dvec2 sample) {
    if (draw.tile->borrows) {
        return sample;
    }
    const scene::TileBuilder& builder = draw.terrain->stream->maker();
    return builder.on_overview(builder.first(draw.tile->id) + builder.step(draw.tile->id) * sample);
}

} // namespace

Result<void> GroundShadow::prepare(const view::DrawList& list, int max_side,
                                   view::FrameStats& stats) {
    std::map<const scene::TerrainNode*, Ground> last = std::exchange(grounds_, {});
    below_meshes_ = nullptr;
    for (const view::TerrainDraw& draw : list.terrains) {
        if (!list.sun || !casts_shadows(draw)) {
            continue;
        }
        const bool is_below = below_meshes_ == nullptr && !list.meshes.empty();
        if (is_below) {
            below_meshes_ = draw.terrain;
            world_from_local_ = draw.world_from_local;
        }
        if (!is_below && !has_triangles(list, draw)) {
            continue;
        }
        grounds_[draw.terrain] = std::move(last[draw.terrain]);
        if (auto prepared = prepare(list, draw, max_side, stats); !prepared) {
            return prepared;
        }
    }
    return {};
}

Result<void> GroundShadow::prepare(const view::DrawList& list, const view::TerrainDraw& draw,
                                   int max_side, view::FrameStats& stats) {
    Ground& ground = grounds_.at(draw.terrain);
    const std::shared_ptr<const scene::TerrainSurface>& surface = draw.terrain->surface;
    const auto light = view::light_on(list, draw.world_from_local);
    if (ground.owner.lock() == surface && ground.light == light) {
        ++stats.skipped.uploads_unchanged;
        return {};
    }
    const Grid<float>& heights = surface->heightfield().heights;
    const int step = (std::max(heights.cols(), heights.rows()) - 1) / max_side + 1;
    auto texture =
        upload_mipmapped(shadow_texels(*surface, *light, step), gl::Format::rg32f, stats);
    if (!texture) {
        return texture.error();
    }
    ground = {surface, light, std::move(*texture), static_cast<double>(step)};
    return {};
}

glm::vec4 GroundShadow::bind(const view::TileDraw& draw, glm::vec2 first_sample) const {
    const Ground& ground = grounds_.at(draw.terrain);
    ground.heights.bind(bindings::ground_shadow_unit);
    const glm::dvec2 texels(ground.heights.size());
    const glm::dvec2 first(first_sample);
    const glm::dvec2 last = first + glm::dvec2(draw.tile->cells);
    const glm::dvec2 begin = on_surface(draw, first);
    const glm::dvec2 scale = (on_surface(draw, last) - begin) / glm::dvec2(draw.tile->cells);
    const glm::dvec2 offset = (begin - scale * first) / ground.step + 0.5;
    return {scale / (ground.step * texels), offset / texels};
}

void GroundShadow::bind() const {
    if (below_meshes_ != nullptr) {
        grounds_.at(below_meshes_).heights.bind(bindings::ground_shadow_unit);
    }
}

glm::mat4 GroundShadow::place_on(const view::DrawList& list, const view::MeshDraw& draw) const {
    if (below_meshes_ == nullptr) {
        return glm::mat4(0.0F);
    }
    const Ground& ground = grounds_.at(below_meshes_);
    const terrain::Placement& placement = below_meshes_->surface->placement();
    const Box box = transformed(draw.world_from_local, draw.local_bounds);
    const glm::dmat4 local_from_world = glm::inverse(world_from_local_);
    const glm::dvec2 texels(ground.heights.size());
    const auto place = [&](glm::dvec3 world) {
        const glm::dvec3 local(local_from_world * glm::dvec4(world, 1.0));
        const glm::dvec3 sample = placement.sample_from_world(local).value_or(glm::dvec3(0.0));
        return glm::dvec3((glm::dvec2(sample) / ground.step + 0.5) / texels, sample.z);
    };
    const glm::dvec3 middle = box.center();
    constexpr double min_reach = 1e-3; // metres: of a mesh that is a point
    const double reach = std::max(0.25 * glm::length(box.size()), min_reach);
    glm::dmat4 matrix(1.0);
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 away(0.0);
        away[axis] = reach;
        matrix[axis] =
            glm::dvec4((place(middle + away) - place(middle - away)) / (2.0 * reach), 0.0);
    }
    const glm::dvec3 from_eye = middle - list.camera.eye;
    matrix[3] = glm::dvec4(place(middle) - glm::dmat3(matrix) * from_eye, 1.0);
    return glm::mat4(matrix);
}

} // namespace reljef::render
