#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "engine/terrain/mesh/bisection.h"
#include "engine/terrain/mesh/tile_layout.h"

namespace reljef::terrain {

/// The screen-space error of a view, and its bound. Lengths are metres of the placement's scene
/// frame. In perspective a displacement is at most scale · error · lateral / depth² pixels (the
/// smallest depth and largest lateral distance of both positions), and, because what is visible is
/// in the picture, scale · error · distance_per_depth / depth of the other position; else
/// scale · error.
struct ErrorView {
    double max_error = 1.0; ///< pixels, > 0
    double scale = 1.0;
    bool perspective = true;
    std::array<glm::dvec4, 5> sides{}; ///< of the frustum: dot(xyz, p) + w >= 0, |xyz| = 1
    glm::dvec4 depth{0.0};             ///< dot(xyz, p) + w
    double near = 0.0;                 ///< smallest depth of what is visible; > 0 in perspective
    /// Largest distance from the eye of what is visible, per metre of its depth; >= 1.
    double distance_per_depth = std::numeric_limits<double>::infinity();
    double vertex_rounding = 0.0;      ///< of each place by floats, pixels, at most
    double interpolation = 0.0;        ///< allowed to places within triangles, pixels
    bool exceeded_by_rounding = false; ///< it leaves too little of the bound: max_error is larger
    /// Pixels by which a triangle's corners are rounded more than what is seen of it, times depth
    /// over the radius of its sphere, and their bound: triangles are split as far as it demands.
    double rounding_between = 0.0;
    double max_rounding = 0.0;
    int min_size = 0;             ///< of squares that are split, steps
    glm::dmat3 lateral_axes{1.0}; ///< the lateral distance is |lateral_axes · p + origin|
    glm::dvec3 lateral_origin{0.0};
    double stretch = 1.0; ///< metres of depth and lateral distance per metre of the scene frame
    /// Share of max_error, in (0, 1], where geomorphing begins. A vertex moves from the middle of
    /// the edge that it splits to its own position, which it reaches at max_error. 1: no morphing.
    double morph_from = 1.0;

    friend bool operator==(const ErrorView&, const ErrorView&) = default;
};

/// Whether the screen-space error without this split may exceed the bound. Conservative. True for a
/// split implies true for its parents.
bool exceeds(const ErrorView& view, const Split& split);

/// The offset of a vertex from its own position.
struct VertexMove {
    glm::dvec3 offset{0.0}; ///< scene metres
    double height = 0.0;    ///< true metres

    friend bool operator==(const VertexMove&, const VertexMove&) = default;
};

/// Triangles over places of a heightfield (steps), counter-clockwise from above.
struct Triangulation {
    std::vector<Steps> vertices;
    std::vector<std::uint16_t> indices;
    std::vector<VertexMove> moves = {}; ///< of the vertices; empty: none

    friend bool operator==(const Triangulation&, const Triangulation&) = default;
};

/// The number of triangles that tiles may have together. Counts from any thread.
class TriangleBudget {
public:
    explicit TriangleBudget(std::size_t max) : max_(max) {}

    void add(std::size_t count) { count_ += count; }
    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] bool is_exceeded() const { return count_ > max_; }

private:
    std::size_t max_;
    std::atomic<std::size_t> count_ = 0;
};

struct TileTriangles {
    std::vector<Triangulation> parts; ///< several if the vertices exceed 16-bit indices
    /// No visible point is farther off, pixels: the view's bound, or more where the smallest
    /// squares are too large.
    double error = 0.0;
};

/// The coarsest triangulation of a tile within the error bound. Neighbours share their border
/// vertices and moves, because a move depends on the vertex and the view only. Ends early, with
/// some of the triangles, once the budget is exceeded.
TileTriangles triangulate(const Bisection& bisection, const TileCells& tile, const ErrorView& view,
                          TriangleBudget* budget = nullptr);

/// Bounds the error of a triangle of triangulate() in the view, pixels; the view's bound with
/// geomorphing. `corners`: in the triangle's order.
double triangle_error_in(const ErrorView& view, const Bisection& bisection,
                         const std::array<Steps, 3>& corners);

} // namespace reljef::terrain
