#include "engine/view/picture/label_ground.h"

#include <memory>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include "engine/scene/streaming/tile_stream.h"

namespace reljef::view {
namespace {

using SharedTile = scene::GroundTiles::SharedTile;

// Those that are not the surface's own.
std::vector<SharedTile> streamed_tiles(const DrawList& list, const TerrainDraw& draw) {
    std::vector<SharedTile> tiles;
    for (const TileDraw& tile : list.tiles) {
        if (tile.terrain == draw.terrain && !tile.tile->borrows) {
            tiles.push_back(tile.tile);
        }
    }
    if (draw.search) {
        tiles.insert(tiles.end(), draw.search->tiles.begin(), draw.search->tiles.end());
    }
    return tiles;
}

std::optional<scene::GroundTiles> ground_tiles(const DrawList& list, const TerrainDraw& draw) {
    const auto& stream = draw.terrain->stream;
    const std::vector<SharedTile> tiles = streamed_tiles(list, draw);
    return stream == nullptr || tiles.empty()
               ? std::nullopt
               : std::optional<scene::GroundTiles>(std::in_place, stream->maker(), tiles);
}

} // namespace

LabelGround::LabelGround(const DrawList& list, const TerrainDraw& draw)
    : surface_(*draw.terrain->surface), world_from_local_(draw.world_from_local),
      local_from_world_(glm::inverse(draw.world_from_local)),
      last_(surface_.heightfield().heights.cols() - 1, surface_.heightfield().heights.rows() - 1),
      caster_(surface_.heightfield().heights.view(), surface_.pyramid(), surface_.placement()),
      tiles_(ground_tiles(list, draw)) {}

bool LabelGround::is_inside(glm::dvec2 sample) const {
    return sample.x >= 0.0 && sample.y >= 0.0 && sample.x <= last_.x && sample.y <= last_.y;
}

std::optional<double> LabelGround::height(glm::dvec2 sample) const {
    if (!is_inside(sample)) {
        return std::nullopt;
    }
    return tiles_ ? tiles_->height_at(sample)
                  : terrain::bilinear_height(surface_.heightfield().heights.view(), sample);
}

glm::dvec3 LabelGround::place(glm::dvec2 sample, double height) const {
    const glm::dvec3 local = surface_.placement().world_from_sample({sample, height});
    return glm::dvec3(world_from_local_ * glm::dvec4(local, 1.0));
}

glm::dvec3 LabelGround::up(glm::dvec3 place) const {
    const auto local = glm::dvec3(local_from_world_ * glm::dvec4(place, 1.0));
    return glm::normalize(glm::dmat3(world_from_local_) * surface_.placement().up(local));
}

bool LabelGround::is_met(const Ray& ray, Interval range) {
    const Ray local{glm::dvec3(local_from_world_ * glm::dvec4(ray.origin, 1.0)),
                    glm::dmat3(local_from_world_) * ray.direction};
    return tiles_ ? tiles_->first_hit(local, range).has_value()
                  : caster_.first_hit(local, range).has_value();
}

} // namespace reljef::view
