#include "engine/scene/graph/ground_pick.h"

#include <algorithm>
#include <cmath>

#include "engine/scene/streaming/tile_stream.h"
#include "engine/terrain/field/surface_caster.h"

namespace reljef::scene {

using terrain::TreeTile;

GroundTiles::GroundTiles(const TileBuilder& builder, const std::vector<SharedTile>& tiles)
    : builder_(builder) {
    for (const SharedTile& tile : tiles) {
        parts_[tile->id].tile = tile;
    }
    for (auto& [id, part] : parts_) {
        const auto children = builder.tree().children(id);
        part.shows_something = children.empty() ||
                               !std::all_of(children.begin(), children.end(),
                                            [&](TreeTile child) { return parts_.contains(child); });
    }
}

// The tiles whose bounds a ray crosses, by where it enters them.
std::vector<GroundTiles::CrossedTile> GroundTiles::crossed_by(const Ray& ray,
                                                              reljef::Interval range) {
    std::vector<CrossedTile> crossed;
    for (auto& [id, part] : parts_) {
        if (!part.shows_something) {
            continue;
        }
        if (const auto inside = intersect(ray, part.tile->bounds, range)) {
            crossed.push_back({&part, inside->begin});
        }
    }
    std::sort(crossed.begin(), crossed.end(),
              [](const auto& a, const auto& b) { return a.entry < b.entry; });
    return crossed;
}

// Whether there is a finer tile at a place of a tile, in its vertices.
bool GroundTiles::is_refined(TreeTile tile, glm::dvec2 vertex) const {
    glm::dvec2 place = vertex / static_cast<double>(terrain::tree_tile_cells);
    while (tile.level > 0) {
        const glm::ivec2 half(place.x < 0.5 ? 0 : 1, place.y < 0.5 ? 0 : 1);
        tile = {tile.level - 1, 2 * tile.col + half.x, 2 * tile.row + half.y};
        place = 2.0 * place - glm::dvec2(half);
        if (parts_.contains(tile)) {
            return true;
        }
    }
    return false;
}

// The first hit of a tile where there is no finer one.
std::optional<terrain::SurfaceHit> GroundTiles::hit_of(Part& part, const Ray& ray,
                                                       reljef::Interval range) const {
    constexpr int max_hits = 64; // of a ray through one tile: crossings of refined parts
    const TerrainTile& tile = *part.tile;
    const GridView<const float> heights = tile.heightfield.heights.view();
    if (!part.pyramid) {
        part.pyramid.emplace(heights);
    }
    const terrain::SurfaceCaster caster(heights, *part.pyramid, *tile.placement);
    for (int i = 0; i < max_hits; ++i) {
        const auto hit = caster.first_hit(ray, range);
        if (!hit || !is_refined(tile.id, glm::dvec2(hit->sample))) {
            return hit;
        }
        range.begin = std::nextafter(hit->t, range.end);
    }
    return std::nullopt;
}

std::optional<GroundHit> GroundTiles::first_hit(const Ray& ray, reljef::Interval range) {
    std::optional<GroundHit> nearest;
    for (const CrossedTile& crossed : crossed_by(ray, range)) {
        if (nearest && crossed.entry > nearest->t) {
            break;
        }
        const auto hit = hit_of(*crossed.part, ray, range);
        if (hit && (!nearest || hit->t < nearest->t)) {
            const terrain::Placement& placement = *crossed.part->tile->placement;
            const glm::dvec2 sample =
                builder_.on_overview(placement.on_terrain(glm::dvec2(hit->sample)));
            nearest = GroundHit{hit->t, ray.at(hit->t), {sample, hit->sample.z}};
        }
    }
    return nearest;
}

std::optional<double> GroundTiles::height_at(glm::dvec2 overview_sample) const {
    const glm::dvec2 sample = builder_.from_overview(overview_sample);
    for (int level = 0; level <= builder_.tree().root().level; ++level) {
        const auto found = parts_.find(builder_.tile_at(level, sample));
        if (found != parts_.end()) {
            const TerrainTile& tile = *found->second.tile;
            return terrain::bilinear_height(tile.heightfield.heights.view(),
                                            tile.placement->lattice()->from_terrain(sample));
        }
    }
    return std::nullopt;
}

std::optional<GroundHit> pick_ground(const TerrainNode& terrain, const Ray& ray) {
    if (!is_finite(ray)) {
        return std::nullopt;
    }
    if (terrain.stream != nullptr && terrain.stream->find(terrain.stream->tree().root())) {
        return GroundTiles(terrain.stream->maker(), terrain.stream->loaded()).first_hit(ray);
    }
    const auto hit = terrain.surface->pick(ray);
    return hit ? std::optional(GroundHit{hit->t, ray.at(hit->t), hit->sample}) : std::nullopt;
}

} // namespace reljef::scene
