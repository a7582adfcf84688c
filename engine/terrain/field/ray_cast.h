#pragma once

#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/core/grid.h"
#include "engine/terrain/field/min_max_pyramid.h"
#include "engine/terrain/field/tiled_surface.h"

namespace reljef::terrain {

/// The intersection of a ray with a bilinear height surface.
struct SurfaceHit {
    double t = 0.0;         ///< along the ray
    glm::dvec3 sample{0.0}; ///< col, row, height (metres)
};

/// The first crossing from above to below of a ray in sample coordinates (col, row, height) with
/// the bilinear surface. The pyramid skips blocks that the ray cannot touch (Tevs et al. 2008). In
/// each cell the crossing is the exact root of a quadratic in t. A ray that enters beneath the
/// surface at the border continues to a front face. A ray that is not finite has no hit.
/// Precondition: `pyramid` was made from `heights`.
std::optional<SurfaceHit> first_hit(GridView<const float> heights, const MinMaxPyramid& pyramid,
                                    const Ray& sample_ray, Interval range);

/// Side of the surface that a ray is on.
enum class Side { unknown, above, below };

struct Stretch {
    std::optional<SurfaceHit> hit;
    Side side = Side::unknown; ///< at the end
};

/// As first_hit() for the piece of a ray over a tile. Before it, the ray was on `side`. A piece
/// that is not over the tile keeps its side. The hit depends on the heights of the cells along the
/// ray only, not on the size of the tile. Precondition: a finite ray.
Stretch follow(const SurfaceTile& tile, const Ray& sample_ray, Interval range, Side side);

/// Walks front to back through the tiles that a ray in sample coordinates crosses. All walks of a
/// ray cross a line between tiles at the same t.
class TileWalk {
public:
    TileWalk(const TiledSurface& surface, const Ray& sample_ray, Interval range);

    /// Whether there is a tile.
    [[nodiscard]] bool is_inside() const;
    [[nodiscard]] glm::ivec2 tile() const { return tile_; }
    /// Of the ray inside the tile.
    [[nodiscard]] Interval stretch() const;
    void advance();
    /// To a tile of the walk.
    void resume_at(glm::ivec2 tile);

private:
    [[nodiscard]] double leaving_time(int axis) const;

    Ray ray_;
    glm::dvec2 inverse_;
    glm::ivec2 last_;
    int cells_;
    glm::ivec2 tile_{0};
    double t_;
    double end_;
};

} // namespace reljef::terrain
