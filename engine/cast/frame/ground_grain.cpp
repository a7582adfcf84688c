#include "engine/cast/frame/ground_grain.h"

#include <algorithm>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "engine/scene/streaming/light.h"

namespace reljef::cast {
namespace {

static_assert(GrainPaint::max_patterns == view::GrainView::max_patterns);
static_assert(GrainPaint::max_levels == material::GrainMap::level_count);

GrainPaint paint_of(const view::GrainView& view, const material::GrainMap& map) {
    GrainPaint paint;
    paint.texels = map.texels().data();
    for (int level = 0; level < material::GrainMap::level_count; ++level) {
        paint.begin.at(static_cast<std::size_t>(level)) =
            static_cast<std::int32_t>(material::GrainMap::begin(level));
    }
    paint.layer_texels = static_cast<int>(material::grain_layer_texels);
    paint.side = material::GrainMap::side;
    paint.level_count = material::GrainMap::level_count;
    paint.strength = view.strength;
    paint.pattern_count = view.pattern_count;
    paint.patterns = view.patterns;
    paint.up = view.up;
    paint.level_light = view.level_light;
    return paint;
}

// Normals are perpendicular to the surface whatever the three axes are.
glm::mat3 normal_from_slopes(const view::GrainView& view, const PlacedTile& tile) {
    glm::dmat3 metres = view.metres_per_sample;
    metres[0] /= tile.scale.x;
    metres[1] /= tile.scale.y;
    return glm::mat3(glm::transpose(glm::inverse(metres)));
}

bool is_grain_near(const view::DrawList& list, const scene::TerrainNode& terrain) {
    const auto is_near = [&](double distance) {
        return view::shows_grain(list, terrain, distance);
    };
    return std::ranges::any_of(list.tiles,
                               [&](const view::TileDraw& draw) {
                                   return draw.terrain == &terrain && is_near(draw.distance);
                               }) ||
           std::ranges::any_of(list.terrains, [&](const view::TerrainDraw& draw) {
               return draw.terrain == &terrain && draw.search && is_near(draw.search->distance);
           });
}

} // namespace

void set_normals(const view::GrainView& view, PlacedTiles& placed) {
    for (PlacedTile& tile : placed.tiles) {
        tile.paint.normal_from_slopes = normal_from_slopes(view, tile);
    }
}

const GrainPaint* GroundGrain::prepare(const view::DrawList& list, const SeenTerrain& seen,
                                       const view::GrainView& view) {
    if (!is_grain_near(list, *seen.node)) {
        return nullptr;
    }
    if (!map_) {
        map_.emplace();
    }
    paint_ = paint_of(view, *map_);
    paint_.turn = view::GrainView::turn;
    if (list.sun) {
        paint_.to_sun = glm::vec3(view::turned(scene::to_light(*list.sun)));
    }
    paint_.metres_a_pixel = scene::metres_a_pixel(list.camera, list.size);
    return &paint_;
}

} // namespace reljef::cast
