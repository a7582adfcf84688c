#include "engine/view/tile_gaps.h"

#include <algorithm>
#include <array>
#include <optional>

namespace reljef::view {
namespace {

using terrain::TreeTile;

// Errors of an unproven tile: wider gaps beside one were not seen.
constexpr double errors_of_gaps = 16.0;

// How far a tile's border may be from the samples' surface, scene metres.
double error_of_border(const scene::TileSummary& tile, double exaggeration) {
    if (!tile.is_proven) {
        return errors_of_gaps * tile.error;
    }
    // Voids are filled differently at each level.
    return tile.has_voids ? std::max(tile.error, exaggeration * (tile.range.high - tile.range.low))
                          : tile.error;
}

// The tile of the same size beside a tile; absent beyond the tree.
std::optional<TreeTile> beside(const terrain::TileTree& tree, TreeTile tile, glm::ivec2 way) {
    const int side = terrain::tree_tile_cells << tile.level;
    const int cols = (tree.cols() - 2) / side + 1;
    TreeTile found{tile.level, tile.col + way.x, tile.row + way.y};
    if (tree.wraps_longitude()) {
        found.col = (found.col + cols) % cols;
    }
    const bool is_inside = found.col >= 0 && found.row >= 0 && found.col < cols &&
                           found.row <= (tree.rows() - 2) / side;
    return is_inside ? std::optional(found) : std::nullopt;
}

} // namespace

std::map<TreeTile, double> tile_gaps(const terrain::TileTree& tree,
                                     std::span<const scene::TileSummary* const> tiles,
                                     double exaggeration) {
    std::map<TreeTile, double> errors;
    for (const scene::TileSummary* const tile : tiles) {
        errors.emplace(tile->id, error_of_border(*tile, exaggeration));
    }
    constexpr std::array ways{glm::ivec2(1, 0), glm::ivec2(-1, 0), glm::ivec2(0, 1),
                              glm::ivec2(0, -1)};
    std::map<TreeTile, double> gaps;
    for (const auto& [tile, error] : errors) {
        for (const glm::ivec2 way : ways) {
            auto neighbour = beside(tree, tile, way);
            while (neighbour && !errors.contains(*neighbour) &&
                   neighbour->level < tree.root().level) {
                *neighbour = {neighbour->level + 1, neighbour->col / 2, neighbour->row / 2};
            }
            if (const auto found = neighbour ? errors.find(*neighbour) : errors.end();
                found != errors.end()) {
                const double gap = error + found->second;
                gaps[tile] = std::max(gaps[tile], gap);
                gaps[found->first] = std::max(gaps[found->first], gap);
            }
        }
    }
    return gaps;
}

} // namespace reljef::view
