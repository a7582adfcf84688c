#include "engine/cast/frame/seen_terrain.h"

#include <algorithm>

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
    for (const view::TerrainDraw& draw : list.reliefs) {
        SeenTerrain& terrain = found_or_added(seen, draw.terrain, draw.world_from_local);
        for (const auto& tile : draw.tiles) {
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

} // namespace reljef::cast
