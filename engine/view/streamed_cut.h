#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/terrain/mesh/bisection_mesh.h"
#include "engine/terrain/tree/stitching.h"
#include "engine/view/draw_list.h"

namespace reljef::view {

/// Some of a tile's triangles, counter-clockwise from above.
struct CutTriangles {
    std::vector<std::uint16_t> vertices; ///< used vertices of the tile, as row-major indices
    std::vector<std::uint16_t> indices;  ///< into `vertices`, in the order of their first use
};

/// Whether a tile is drawn with fewer triangles than its vertices allow.
bool is_cut(const StreamedDraw& draw);

struct StreamedShape;

/// The state from which a tile's triangles were found.
struct StreamedCut {
    std::shared_ptr<const StreamedShape> shape; ///< null until triangles are needed
    std::optional<terrain::ErrorView> view;     ///< empty until the triangles are drawn
    Grid<std::uint8_t> splits;                  ///< required by the tiles around it
};

/// A tile and its lasting state.
struct TileToCut {
    const StreamedDraw* draw = nullptr;
    StreamedCut* cut = nullptr;
    std::optional<CutTriangles> triangles = {}; ///< empty if unchanged
    terrain::ErrorView view = {};               ///< of these triangles
};

/// Finds the triangles of all tiles of a cover: as few as the view allows if the tiles still meet
/// vertex on vertex. The triangles get at least half of the error bound, and what the estimated
/// errors of the vertices leave of it, including those of the tiles around (the two errors seldom
/// add up). Does nothing if neither the cover nor a tile's view is new. After drawing new triangles
/// the caller sets StreamedCut::view. Precondition: one tile for each of the cover, or none.
void cut_together(const DrawList& list, const terrain::DrawnTiles& cover, bool is_new_cover,
                  std::span<TileToCut> tiles);

} // namespace reljef::view
