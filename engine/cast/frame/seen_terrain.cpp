#include "engine/cast/frame/seen_terrain.h"

#include <algorithm>
#include <limits>

#include <glm/common.hpp>
#include <glm/vec4.hpp>

#include "engine/scene/streaming/tile_stream.h"

namespace reljef::cast {
namespace {

Box samples_and_heights(const scene::TerrainSurface& surface) {
    const Grid<float>& heights = surface.heightfield().heights;
    const terrain::MinMax total = surface.pyramid().total();
    Box bounds;
    bounds.add(glm::dvec3(0.0, 0.0, total.low));
    bounds.add(glm::dvec3(heights.cols() - 1.0, heights.rows() - 1.0, total.high));
    return bounds;
}

SeenTerrain& found_or_added(std::vector<SeenTerrain>& seen, const scene::TerrainNode* node,
                            const glm::dmat4& world_from_local) {
    const auto found = std::find_if(seen.begin(), seen.end(),
                                    [&](const SeenTerrain& one) { return one.node == node; });
    return found != seen.end()
               ? *found
               : seen.emplace_back(SeenTerrain{node, world_from_local, {}, {}, false});
}

void add_tile(SeenTerrain& seen, const scene::TerrainTile& tile) {
    if (tile.borrows) {
        return;
    }
    seen.has_tiles = true;
    seen.local.add(tile.bounds);
    const scene::TileBuilder& builder = seen.node->stream->maker();
    const terrain::TileLattice lattice = builder.lattice(tile.id);
    seen.samples.add(glm::dvec3(builder.on_overview(lattice.first), tile.range.low));
    seen.samples.add(glm::dvec3(builder.on_overview(lattice.last), tile.range.high));
}

// Where nothing is streamed; a plane has the same rays for all selections.
void add_surface(SeenTerrain& seen) {
    const scene::TerrainSurface& surface = *seen.node->surface;
    if (!seen.has_tiles || !is_curved(*seen.node)) {
        seen.local.add(surface.bounds());
        seen.samples.add(samples_and_heights(surface));
    }
}

} // namespace

std::vector<SeenTerrain> seen_terrains(const view::DrawList& list) {
    std::vector<SeenTerrain> seen;
    for (const view::TerrainDraw* const draw : view::searched_terrains(list)) {
        SeenTerrain& terrain = found_or_added(seen, draw->terrain, draw->world_from_local);
        for (const auto& tile : draw->search->tiles) {
            add_tile(terrain, *tile);
        }
    }
    for (const view::TileDraw& draw : list.tiles) {
        add_tile(found_or_added(seen, draw.terrain, list.world_from_local(draw)), *draw.tile);
    }
    for (SeenTerrain& terrain : seen) {
        add_surface(terrain);
    }
    return seen;
}

bool is_curved(const scene::TerrainNode& node) {
    return node.surface->placement().kind() == terrain::PlacementKind::ellipsoid;
}

std::array<glm::dvec3, 8> corners_of(const Box& box) {
    std::array<glm::dvec3, 8> corners;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        corners[i] = {(i & 1U) != 0 ? box.high.x : box.low.x,
                      (i & 2U) != 0 ? box.high.y : box.low.y,
                      (i & 4U) != 0 ? box.high.z : box.low.z};
    }
    return corners;
}

PixelBlock seen_pixels(const glm::dmat4& clip_from_local, glm::ivec2 size,
                       const std::array<glm::dvec3, 8>& corners) {
    glm::dvec2 low(std::numeric_limits<double>::infinity());
    glm::dvec2 high = -low;
    for (const glm::dvec3& corner : corners) {
        const glm::dvec4 clip = clip_from_local * glm::dvec4(corner, 1.0);
        if (!(clip.w > 0.0)) {
            return {{0, 0}, size}; // reaches behind the eye
        }
        const glm::dvec2 pixel =
            (0.5 + glm::dvec2(0.5, -0.5) * glm::dvec2(clip) / clip.w) * glm::dvec2(size);
        low = glm::min(low, pixel);
        high = glm::max(high, pixel);
    }
    constexpr double margin = 1.0; // floats of rays are off by far less
    const glm::dvec2 end(size);
    const glm::ivec2 first(glm::floor(glm::clamp(low - margin, glm::dvec2(0.0), end)));
    const glm::ivec2 last(glm::ceil(glm::clamp(high + margin, glm::dvec2(0.0), end)));
    return {first, last - first};
}

} // namespace reljef::cast
