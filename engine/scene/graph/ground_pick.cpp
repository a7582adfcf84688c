#include "engine/scene/graph/ground_pick.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <set>
#include <vector>

#include "engine/scene/streaming/tile_stream.h"

namespace reljef::scene {
namespace {

using terrain::TreeTile;

struct CrossedTile {
    std::shared_ptr<const TerrainTile> tile;
    double entry = 0.0; // where the ray enters the tile's bounds
};

// The loaded tiles of a stream.
class LoadedTiles {
public:
    explicit LoadedTiles(const TileStream& stream) : stream_(stream), tiles_(stream.loaded()) {
        for (const auto& tile : tiles_) {
            loaded_.insert(tile->id);
        }
    }

    // The tiles whose bounds a ray crosses, by where it enters them.
    [[nodiscard]] std::vector<CrossedTile> crossed_by(const Ray& ray) const {
        std::vector<CrossedTile> crossed;
        for (const auto& tile : tiles_) {
            if (const auto part = intersect(ray, tile->bounds); part && shows_something(tile->id)) {
                crossed.push_back({tile, part->begin});
            }
        }
        std::sort(crossed.begin(), crossed.end(),
                  [](const auto& a, const auto& b) { return a.entry < b.entry; });
        return crossed;
    }

    // Whether a finer tile is loaded at a place of a tile, in its vertices.
    [[nodiscard]] bool is_refined(TreeTile tile, glm::dvec2 vertex) const {
        glm::dvec2 place = vertex / static_cast<double>(terrain::tree_tile_cells);
        while (tile.level > 0) {
            const glm::ivec2 half(place.x < 0.5 ? 0 : 1, place.y < 0.5 ? 0 : 1);
            tile = {tile.level - 1, 2 * tile.col + half.x, 2 * tile.row + half.y};
            place = 2.0 * place - glm::dvec2(half);
            if (loaded_.contains(tile)) {
                return true;
            }
        }
        return false;
    }

private:
    // Whether a part of the tile may have no finer tiles.
    [[nodiscard]] bool shows_something(TreeTile tile) const {
        const auto children = stream_.tree().children(tile);
        return children.empty() ||
               !std::all_of(children.begin(), children.end(),
                            [&](TreeTile child) { return loaded_.contains(child); });
    }

    const TileStream& stream_;
    std::vector<std::shared_ptr<const TerrainTile>> tiles_;
    std::set<TreeTile> loaded_;
};

// The first hit of a tile where no finer one is loaded.
std::optional<terrain::SurfaceHit> hit_of(const LoadedTiles& loaded, const TerrainTile& tile,
                                          const Ray& ray) {
    constexpr int max_hits = 64; // of a ray through one tile: crossings of refined parts
    const GridView<const float> heights = tile.heightfield.heights.view();
    const terrain::MinMaxPyramid pyramid(heights);
    const terrain::SurfaceCaster caster(heights, pyramid, *tile.placement);
    reljef::Interval part{0.0, std::numeric_limits<double>::infinity()};
    for (int i = 0; i < max_hits; ++i) {
        const auto hit = caster.first_hit(ray, part);
        if (!hit || !loaded.is_refined(tile.id, glm::dvec2(hit->sample))) {
            return hit;
        }
        part.begin = std::nextafter(hit->t, part.end);
    }
    return std::nullopt;
}

std::optional<GroundHit> pick_tiles(const TerrainNode& terrain, const Ray& ray) {
    const LoadedTiles loaded(*terrain.stream);
    std::optional<GroundHit> nearest;
    for (const CrossedTile& crossed : loaded.crossed_by(ray)) {
        if (nearest && crossed.entry > nearest->t) {
            break;
        }
        const auto hit = hit_of(loaded, *crossed.tile, ray);
        if (hit && (!nearest || hit->t < nearest->t)) {
            const TileBuilder& builder = terrain.stream->maker();
            const glm::dvec2 sample =
                builder.on_overview(crossed.tile->placement->on_terrain(glm::dvec2(hit->sample)));
            nearest = GroundHit{hit->t, ray.at(hit->t), {sample, hit->sample.z}};
        }
    }
    return nearest;
}

} // namespace

std::optional<GroundHit> pick_ground(const TerrainNode& terrain, const Ray& ray) {
    if (!is_finite(ray)) {
        return std::nullopt;
    }
    if (terrain.stream != nullptr && terrain.stream->find(terrain.stream->tree().root())) {
        return pick_tiles(terrain, ray);
    }
    const auto hit = terrain.surface->pick(ray);
    return hit ? std::optional(GroundHit{hit->t, ray.at(hit->t), hit->sample}) : std::nullopt;
}

} // namespace reljef::scene
