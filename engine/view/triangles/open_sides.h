#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "engine/terrain/tree/tile_tree.h"

namespace reljef::view {

enum class TileSide : std::uint8_t { north, east, south, west };
TileSide opposite(TileSide side);
/// Whether columns, not rows, count along a side.
bool runs_along_rows(TileSide side);

/// A part of a tile's side where its triangles may end above or below what lies beyond.
struct OpenSide {
    TileSide side = TileSide::north;
    double from = 0.0; ///< along the side, samples of the terrain
    double to = 0.0;
    std::optional<terrain::TreeTile> neighbour; ///< absent: nothing is drawn beyond

    friend bool operator==(const OpenSide&, const OpenSide&) = default;
};

/// The drawn tiles of a terrain, side by side.
class DrawnTiles {
public:
    DrawnTiles(const terrain::TileTree& tree, std::span<const terrain::TreeTile> tiles);

    /// The open sides of a drawn tile. Two neighbours share one, which only the smaller of both
    /// gets. Sides at the end of the terrain are not open.
    [[nodiscard]] std::vector<OpenSide> open_sides(terrain::TreeTile tile) const;

private:
    [[nodiscard]] std::optional<terrain::TreeTile> beside(terrain::TreeTile tile,
                                                          TileSide side) const;
    [[nodiscard]] std::optional<terrain::TreeTile> drawn_around(terrain::TreeTile tile) const;
    [[nodiscard]] bool has_drawn_parts(terrain::TreeTile tile) const {
        return parents_.contains(tile);
    }
    void add_undrawn(terrain::TreeTile beyond, TileSide side, std::vector<OpenSide>& sides) const;
    [[nodiscard]] OpenSide side_of(terrain::TreeTile tile, TileSide side) const;

    terrain::TileTree tree_;
    std::set<terrain::TreeTile> tiles_;
    std::set<terrain::TreeTile> parents_; // of drawn tiles, at all levels
};

} // namespace reljef::view
