#include "engine/cast/frame/earth_rays.h"

#include <cmath>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/matrix.hpp>

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

std::vector<TilePiece> surface_pieces(const scene::TerrainNode& node) {
    const Grid<float>& heights = node.surface->heightfield().heights;
    terrain::TileLattice all;
    all.last = glm::dvec2(heights.cols() - 1, heights.rows() - 1);
    all.cells = {heights.cols() - 1, heights.rows() - 1};
    all.rows = rows_of(node);
    return pieces_of(all, all.last, glm::dvec2(0.0));
}

void join_ends(const SeenTerrain& seen, std::span<const TilePiece> pieces, PlacedTiles& placed) {
    if (!(seen.columns_around > 0.0)) {
        return;
    }
    double first = 0.0;
    if (seen.has_tiles) {
        first = seen.node->stream->maker().on_overview(glm::dvec2(0.0)).x;
    } else {
        std::vector<TileNode> boxes;
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            const TilePiece& piece = pieces[i];
            placed.tiles[i].walls |= west_wall | east_wall;
            const glm::dvec2 end = piece.first + piece.step * glm::dvec2(piece.cells);
            TileNode& node = boxes.emplace_back();
            node.box.add(glm::dvec3(piece.first, seen.samples.low.z));
            node.box.add(glm::dvec3(end, seen.samples.high.z));
            node.seen = placed.tiles[i].seen;
            node.tile = static_cast<int>(i);
        }
        add_piece_nodes(pieces, boxes, placed.nodes);
    }
    placed.turn = {first, first + seen.columns_around};
}

} // namespace reljef::cast
