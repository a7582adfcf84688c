#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "engine/terrain/mesh/bisection.h"
#include "engine/terrain/mesh/tile_layout.h"

namespace reljef::terrain {

/// How a picture shows displacements of a surface, and the most it may show. All in the scene frame
/// of the placement, metres. With a perspective a point is seen displaced by at most
/// scale · error · lateral / depth² pixels (the least depth, the greatest lateral distance of where
/// it is and where it belongs); without one by scale · error.
struct ErrorView {
    double max_error = 1.0; ///< pixels, > 0
    double scale = 1.0;
    bool perspective = true;
    std::array<glm::dvec4, 5> sides{}; ///< of what is seen: dot(xyz, p) + w >= 0, xyz of length 1
    glm::dvec4 depth{0.0};             ///< dot(xyz, p) + w
    glm::dmat3 lateral_axes{1.0};      ///< the lateral distance is |lateral_axes · p + origin|
    glm::dvec3 lateral_origin{0.0};
    double stretch = 1.0; ///< of what is a metre in the scene frame, in depth and lateral distance
    /// Share of the most error, in (0, 1], from which on vertices rise from the middle of the edge
    /// that they split to their own places, where they are at the most error; 1: at once.
    double morph_from = 1.0;

    friend bool operator==(const ErrorView&, const ErrorView&) = default;
};

/// Whether the view may show more than its most error where a split is not made: never no where it
/// does, and, once yes, yes for each split that one needs.
bool exceeds(const ErrorView& view, const Split& split);

/// How far a vertex is from its own place.
struct VertexMove {
    glm::dvec3 offset{0.0}; ///< scene metres
    double height = 0.0;    ///< true metres

    friend bool operator==(const VertexMove&, const VertexMove&) = default;
};

/// Triangles over places of a heightfield (steps), counter-clockwise from above: as many vertices
/// as 16-bit indices reach.
struct Triangulation {
    std::vector<glm::ivec2> vertices;
    std::vector<std::uint16_t> indices;
    std::vector<VertexMove> moves = {}; ///< of the vertices; empty: all are at their places

    friend bool operator==(const Triangulation&, const Triangulation&) = default;
};

/// The bisection of a tile as coarse as the view allows, which covers each point of it once. Its
/// neighbours' meet it vertex on vertex, moved alike: a move hangs on the vertex and the view
/// alone. Where vertices rise, the surface changes without a step as the view does. More than one
/// only where one has too many vertices.
std::vector<Triangulation> triangulate(const Bisection& bisection, const Tile& tile,
                                       const ErrorView& view);

/// The same with vertices at samples alone, and with all splits where `kept` is 1: of the tile's
/// samples, as shared_splits() gives them.
Triangulation triangulate_samples(const Bisection& bisection, const Tile& tile,
                                  const ErrorView& view, const Grid<std::uint8_t>& kept);

} // namespace reljef::terrain
