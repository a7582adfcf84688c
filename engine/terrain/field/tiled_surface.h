#pragma once

#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/core/grid.h"
#include "engine/terrain/field/min_max_pyramid.h"

namespace reljef::terrain {

/// Part of a surface's samples. Borrows both.
struct SurfaceTile {
    GridView<const float> heights;          ///< metres
    const MinMaxPyramid* pyramid = nullptr; ///< made from the heights
    glm::ivec2 first{0};                    ///< sample of heights(0, 0)
};

/// A placed bilinear surface whose samples lie in square tiles. Neighbours share their border
/// samples. Tiles may not be in memory.
class TiledSurface {
public:
    TiledSurface() = default;
    virtual ~TiledSurface() = default;
    TiledSurface(const TiledSurface&) = default;
    TiledSurface& operator=(const TiledSurface&) = default;

    [[nodiscard]] virtual glm::ivec2 last_sample() const = 0;
    /// Cells along a side; fewer at the far sides.
    [[nodiscard]] virtual int tile_cells() const = 0;
    /// Tile (col, row); null if it is not in memory.
    [[nodiscard]] virtual const SurfaceTile* tile(glm::ivec2 at) const = 0;
    /// Bounds of a tile's heights, if they are known.
    [[nodiscard]] virtual std::optional<MinMax> range(glm::ivec2 at) const = 0;

    /// A world ray in sample coordinates with the same t, if the mapping is affine.
    [[nodiscard]] virtual std::optional<Ray> sample_ray(const Ray& world_ray) const = 0;
    /// As Placement.
    [[nodiscard]] virtual glm::dvec3 world_from_sample(glm::dvec3 sample) const = 0;
    [[nodiscard]] virtual std::optional<glm::dvec3> sample_from_world(glm::dvec3 world) const = 0;
    /// By how many columns sample_from_world() jumps at the seam of a globe; empty without one.
    [[nodiscard]] virtual std::optional<double> columns_all_around() const = 0;

    [[nodiscard]] bool is_over(glm::dvec3 sample) const {
        const glm::ivec2 last = last_sample();
        return sample.x >= 0.0 && sample.y >= 0.0 && sample.x <= last.x && sample.y <= last.y;
    }
    /// The tile of a sample. Precondition: is_over().
    [[nodiscard]] glm::ivec2 tile_at(glm::dvec2 sample) const {
        return glm::min(glm::ivec2(sample), last_sample() - 1) / tile_cells();
    }
};

} // namespace reljef::terrain
