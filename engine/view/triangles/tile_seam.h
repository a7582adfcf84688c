#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

#include "engine/view/triangles/open_sides.h"
#include "engine/view/triangles/tile_cut.h"

namespace reljef::view {

// Tiles of a stream stand alone, so two neighbours may show their common border at different
// heights. A seam joins the points of both borders at equal places. Both are within the errors that
// the frame states, so all between them is.

/// A vertex of a tile's triangles on one of its sides.
struct BorderVertex {
    double at = 0.0; ///< along the side, samples of the terrain
    GridVertex vertex;
};
/// The vertices along each side in the order of TileSide, sorted by `at`.
using TileBorder = std::array<std::vector<BorderVertex>, 4>;

TileBorder border_of(const TileSurface& surface, const CutMesh& mesh);
/// Of a tile with a vertex at every sample.
TileBorder border_of_samples(const TileSurface& surface);

/// How far a tile may be above the true border, where nothing is drawn beyond.
struct BorderError {
    double metres = 0.0; ///< scene metres along the vertical
    double slope = 0.0;  ///< more: metres per metre from the eye, seen from the side
    glm::dvec3 eye{0.0}; ///< local metres

    friend bool operator==(const BorderError&, const BorderError&) = default;
};
/// That of tiles that are not cut is rounded up, so that it seldom changes.
BorderError border_error(const DrawList& list, const TileDraw& draw);

/// A part of a tile's seams.
struct SeamPart {
    std::vector<GridVertex> vertices;
    std::vector<std::uint16_t> indices;
};

/// Makes the seams of a tile, with the attributes of that tile. The arguments outlive it.
class SeamMaker {
public:
    SeamMaker(const TileSurface& surface, const TileBorder& own) : surface_(surface), own_(own) {}

    /// To the border of a neighbour.
    void join(const OpenSide& open, const TileBorder& neighbour);
    /// To the lowest true border, where nothing is drawn beyond.
    void hang(const OpenSide& open, const BorderError& error);

    std::vector<SeamPart> take() { return std::move(parts_); }

private:
    struct Line;
    [[nodiscard]] Line line_along(std::span<const BorderVertex> border, TileSide side,
                                  std::span<const double> places) const;
    [[nodiscard]] GridVertex with_own_place(GridVertex vertex, TileSide side, double at) const;
    void add_walls(const Line& own, const Line& other, TileSide side);
    void add_flaps(std::span<const BorderVertex> border, const Line& line, TileSide side);
    void add_triangle(const GridVertex& a, const GridVertex& b, const GridVertex& c);

    const TileSurface& surface_;
    const TileBorder& own_;
    std::vector<SeamPart> parts_;
};

} // namespace reljef::view
