#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "engine/scene/streamed_tile.h"
#include "engine/terrain/mesh/bisection_mesh.h"
#include "engine/terrain/tree/stitching.h"
#include "engine/view/draw_list.h"

namespace reljef::view {

/// Some of a tile's triangles, counter-clockwise from above.
struct CutTriangles {
    std::vector<std::uint16_t> vertices; ///< of the tile's, row after row: those that are used
    std::vector<std::uint16_t> indices;  ///< of `vertices`, in the order of their first use
};

/// A streamed tile as heights over the plane that touches it, with their bisection: what fewer
/// triangles of its vertices may be off, the curvature of the Earth included.
class StreamedShape {
public:
    explicit StreamedShape(const scene::StreamedTile& tile);
    ~StreamedShape();
    StreamedShape(StreamedShape&&) noexcept;
    StreamedShape& operator=(StreamedShape&&) noexcept;

    /// As terrain::border_splits().
    [[nodiscard]] std::vector<glm::ivec2> border_splits(const terrain::ErrorView& view) const;
    /// As few triangles as the view and the splits that must be made allow.
    [[nodiscard]] CutTriangles triangles(const terrain::ErrorView& view,
                                         const Grid<std::uint8_t>& splits) const;
    /// Local metres from those of the plane.
    [[nodiscard]] const glm::dmat4& local_from_plane() const { return local_from_plane_; }

private:
    struct Data;
    glm::dmat4 local_from_plane_{1.0};
    std::unique_ptr<const Data> data_;
};

/// Whether a tile is drawn with fewer triangles than its vertices have.
bool is_cut(const StreamedDraw& draw);

/// What a tile was cut by, and for.
struct StreamedCut {
    std::optional<StreamedShape> shape;     ///< made where fewer triangles are asked for
    std::optional<terrain::ErrorView> view; ///< absent until those triangles are drawn
    Grid<std::uint8_t> splits;              ///< that had to be made for the tiles around it
};

/// A tile and its cut, which lasts.
struct TileToCut {
    const StreamedDraw* draw = nullptr;
    StreamedCut* cut = nullptr;
    std::optional<CutTriangles> triangles = {}; ///< absent where they are as they were
    terrain::ErrorView view = {};               ///< that they were found for
};

/// Finds the triangles of all tiles of a cover: as few as the view allows where the tiles still
/// meet vertex on vertex. Of the error that is asked for, theirs is what the estimate of the error
/// of the vertices leaves, the tile's own and on its borders those around it (errors of both kinds
/// seldom add up), at least half. Nothing is done
/// where neither the cover is new nor a tile's view; else the view of a cut whose triangles are new
/// is for the caller to set, once they are drawn. Precondition: a tile for each of the cover, or
/// none.
void cut_together(const DrawList& list, const terrain::DrawnTiles& cover, bool is_new_cover,
                  std::span<TileToCut> tiles);

} // namespace reljef::view
