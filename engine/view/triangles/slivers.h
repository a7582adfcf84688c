#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/view/draw_list.h"
#include "engine/view/grid_mesh.h"
#include "engine/view/triangles/tile_cut.h"

namespace reljef::view {

/// Numbers of triangles, ascending.
struct Slivers {
    std::vector<std::uint32_t> mild;   ///< their depth is interpolated
    std::vector<std::uint32_t> narrow; ///< their depth comes from their corners, too

    [[nodiscard]] std::vector<std::uint32_t> all() const;
    friend bool operator==(const Slivers&, const Slivers&) = default;
};

/// Finds the slivers among the triangles of a tile: those that the picture shows so much longer
/// than wide, or so large, that places which a rasterizer interpolates in floats may be farther off
/// than terrain::ErrorView::interpolation and what the triangle's own error leaves of the bound.
/// They take their places from their corners instead, see shaders/terrain/sliver.glsl.
class SliverView {
public:
    /// `cut`: how the tile was cut; its bisection lives as long. Precondition: the tile's triangles
    /// follow an error bound.
    SliverView(const DrawList& list, const TileDraw& draw, const CutOptions& cut);

    struct Triangles {
        std::span<const GridVertex> vertices;
        std::span<const std::uint16_t> indices;
        const terrain::Triangulation* part = nullptr; ///< of the cut; null: of a seam
    };
    /// Triangles beside the picture or behind the eye are none.
    [[nodiscard]] Slivers slivers(const Triangles& triangles) const;

private:
    struct Corner {
        glm::dvec2 pixel{0.0};
        double depth = 0.0;    // metres; 1 without perspective
        glm::dvec2 place{0.0}; // samples from the tile's first
    };
    [[nodiscard]] Corner corner(const GridVertex& vertex) const;
    /// The errors of a rasterizer, pixels, at most.
    struct Rounding {
        double place = 0.0;
        double depth = 0.0;
    };
    [[nodiscard]] Rounding rounding_in(const Corner& a, const Corner& b, const Corner& c) const;
    [[nodiscard]] double unused_error(const Triangles& triangles, std::size_t first) const;

    glm::dmat4 clip_from_offset_; // from the eye, local metres
    glm::dvec3 eye_;              // local metres
    glm::dvec2 size_;             // pixels
    double near_;                 // metres
    double max_error_;            // of interpolated places, pixels
    double max_depth_error_;      // pixels
    terrain::ErrorView cut_view_;
    const terrain::Bisection* bisection_;
};

/// The corners of some of a mesh's triangles, three for each. `triangles`: their numbers.
std::vector<GridVertex> corners_of(std::span<const GridVertex> vertices,
                                   std::span<const std::uint16_t> indices,
                                   std::span<const std::uint32_t> triangles);
/// The corners of the others. `triangles`: ascending.
std::vector<std::uint16_t> without(std::span<const std::uint16_t> indices,
                                   std::span<const std::uint32_t> triangles);

} // namespace reljef::view
