#include "engine/cast/frame/earth_rays.h"

#include <cmath>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include "engine/cast/frame/tile_pieces.h"
#include "engine/scene/streaming/tile_stream.h"

namespace reljef::cast {
namespace {

void add_blocks(const scene::TileBuilder& builder, const geo::WrappedRows& rows,
                const scene::TerrainTile& tile, std::vector<Box>& ground) {
    const terrain::TileLattice lattice = builder.lattice(tile.id);
    const auto sample_at = [&](glm::ivec2 vertex) {
        const glm::dvec2 sample = lattice.first + lattice.step * glm::dvec2(vertex);
        const glm::dvec2 at = builder.on_overview(glm::min(sample, lattice.last));
        return glm::dvec2(at.x, rows.even_row(at.y));
    };
    for (int row = 0; row < tile.blocks.rows(); ++row) {
        for (int col = 0; col < tile.blocks.cols(); ++col) {
            const glm::ivec2 first = scene::cells_per_block * glm::ivec2(col, row);
            const terrain::MinMax heights = tile.blocks(col, row);
            Box& block = ground.emplace_back();
            block.add(glm::dvec3(sample_at(first), heights.low));
            block.add(glm::dvec3(sample_at(first + scene::cells_per_block), heights.high));
        }
    }
}

// Of a terrain in memory: a box for each square of what is seen.
void add_squares(const scene::TerrainSurface& surface, const SeenTerrain& seen,
                 std::vector<Box>& ground) {
    constexpr int squares = 64;
    const Grid<float>& heights = surface.heightfield().heights;
    const glm::ivec2 end(heights.cols() - 2, heights.rows() - 2);
    const glm::dvec2 step = glm::dvec2(seen.samples.size()) / double{squares};
    for (int row = 0; row < squares; ++row) {
        for (int col = 0; col < squares; ++col) {
            const glm::dvec2 from = glm::dvec2(seen.samples.low) + step * glm::dvec2(col, row);
            double turn = 0.0;
            if (seen.columns_around > 0.0) {
                turn = seen.columns_around * std::floor(from.x / seen.columns_around);
            }
            const glm::ivec2 first(glm::floor(from - glm::dvec2(turn, 0.0)));
            glm::ivec2 last(glm::ceil(from + step - glm::dvec2(turn, 0.0)));
            const auto add = [&](glm::ivec2 low, glm::ivec2 high) {
                const terrain::MinMax bounds = surface.pyramid().bounds(
                    glm::clamp(low, glm::ivec2(0), end), glm::clamp(high, glm::ivec2(0), end));
                Box& square = ground.emplace_back();
                square.add(glm::dvec3(from, bounds.low));
                square.add(glm::dvec3(from + step, bounds.high));
            };
            if (seen.columns_around > 0.0 && last.x > end.x) {
                add({0, first.y}, {last.x - end.x, last.y});
                last.x = end.x;
            }
            add(first, last);
        }
    }
}

// Of its streamed tiles in a list, or of its samples.
HeightBounds ground_heights(const view::DrawList& list, const SeenTerrain& seen) {
    std::vector<Box> ground;
    if (seen.has_tiles) {
        for (const scene::TerrainTile* const tile : tiles_in(list, *seen.node)) {
            add_blocks(seen.node->stream->maker(), rows_of(*seen.node), *tile, ground);
        }
    } else {
        add_squares(*seen.node->surface, seen, ground);
    }
    return {seen.samples, ground, seen.has_tiles ? seen.columns_around : 0.0};
}

// Whether the eye is not below the ground. Of streamed ground only its bounds are looked at.
bool begins_above(const view::DrawList& list, const SeenTerrain& seen, const HeightBounds& bounds) {
    const scene::TerrainSurface& surface = *seen.node->surface;
    const auto eye = surface.placement().sample_from_world(
        glm::dvec3(glm::inverse(seen.world_from_local) * glm::dvec4(list.camera.eye, 1.0)));
    if (list.camera.projection != scene::ProjectionKind::perspective || !eye) {
        return true;
    }
    if (seen.has_tiles) {
        Box place;
        place.add(glm::dvec3(eye->x, rows_of(*seen.node).even_row(eye->y), eye->z));
        const Interval ground = bounds.within(place);
        return !(eye->z < ground.begin && ground.begin <= ground.end);
    }
    const Grid<float>& heights = surface.heightfield().heights;
    const glm::dvec2 last(heights.cols() - 1, heights.rows() - 1);
    return eye->z >= terrain::bilinear_height(heights.view(),
                                              glm::clamp(glm::dvec2(*eye), glm::dvec2(0.0), last));
}

} // namespace

std::shared_ptr<const CurvedRays> earth_rays(const view::DrawList& list, const SeenTerrain& seen,
                                             const CurvedRays::Options& options) {
    HeightBounds heights = ground_heights(list, seen);
    const bool is_above = begins_above(list, seen, heights);
    return std::make_shared<const CurvedRays>(
        list.camera, list.size,
        CurvedRays::Terrain{seen.node->surface->placement(), seen.world_from_local, seen.local,
                            seen.samples, std::move(heights), is_above, rows_of(*seen.node)},
        options);
}

std::vector<RowPart> row_parts(const scene::TerrainNode& node) {
    const geo::WrappedRows rows = rows_of(node);
    const int north = rows.wrap().north_rows();
    const int south = rows.wrap().south_rows();
    const int last = node.surface->heightfield().heights.rows() - 1;
    std::vector<int> cuts{0};
    if (north > 0 && last > 1) {
        cuts.push_back(1);
    }
    if (south > 0 && last - 1 > cuts.back()) {
        cuts.push_back(last - 1);
    }
    cuts.push_back(last);
    std::vector<RowPart> parts;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        RowPart& part = parts.emplace_back();
        part.first = cuts[i];
        part.cells = cuts[i + 1] - cuts[i];
        part.even_first = rows.even_row(part.first);
        part.even_step = (rows.even_row(cuts[i + 1]) - part.even_first) / part.cells;
        part.walls = (i > 0 ? north_wall : 0U) | (i + 2 < cuts.size() ? south_wall : 0U);
    }
    return parts;
}

void place_part(const RowPart& part, PlacedTile& tile) {
    tile.walls = part.walls;
    tile.first = {0.0, part.even_first};
    tile.step = {1.0, part.even_step};
    tile.scale = {1.0, 1.0 / part.even_step};
    tile.by = {0.0, -part.even_first / part.even_step};
}

namespace {

// Of tiles from north to south.
int add_nodes(const SeenTerrain& seen, std::span<const PlacedTile> tiles, std::size_t index,
              TileNodes& nodes) {
    const auto over = static_cast<int>(nodes.size());
    const PlacedTile& tile = tiles[index];
    const double end = tile.first.y + tile.step.y * tile.tile->cells().y;
    TileNode node;
    node.box.add(glm::dvec3(0.0, tile.first.y, seen.samples.low.z));
    node.box.add(glm::dvec3(seen.columns_around, end, seen.samples.high.z));
    node.seen = tile.seen;
    node.tile = static_cast<int>(index);
    if (index + 1 == tiles.size()) {
        nodes.push_back(node);
        return over;
    }
    nodes.emplace_back();
    nodes.push_back(node);
    const int beside = add_nodes(seen, tiles, index + 1, nodes);
    nodes[static_cast<std::size_t>(over)] =
        node_over(nodes, {over + 1, -1, beside, -1}, {0.0, end});
    return over;
}

} // namespace

void join_ends(const SeenTerrain& seen, PlacedTiles& placed) {
    if (!(seen.columns_around > 0.0)) {
        return;
    }
    double first = 0.0;
    if (seen.has_tiles) {
        first = seen.node->stream->maker().on_overview(glm::dvec2(0.0)).x;
    } else {
        for (PlacedTile& tile : placed.tiles) {
            tile.walls |= west_wall | east_wall;
        }
        add_nodes(seen, placed.tiles, 0, placed.nodes);
    }
    placed.turn = {first, first + seen.columns_around};
}

} // namespace reljef::cast
