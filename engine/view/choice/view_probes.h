#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/geometry.h"
#include "engine/core/grid.h"
#include "engine/scene/streaming/terrain_surface.h"
#include "engine/terrain/field/min_max_pyramid.h"
#include "engine/view/choice/typical_search.h"
#include "engine/view/draw_list.h"

namespace reljef::view {

/// Rays of an estimate: columns and rows over the picture.
inline constexpr glm::ivec2 view_probes{20, 15};

/// About every fourth sample of a terrain in memory: rays that only count pixels take half to two
/// thirds of their time on it, because it fits a processor's cache.
class ProbedSurface {
public:
    ProbedSurface() = default;
    explicit ProbedSurface(const scene::TerrainSurface& surface);

    /// Where a ray in sample coordinates (col, row, metres) hits: the same coordinates of all
    /// samples.
    [[nodiscard]] std::optional<glm::dvec3> first_hit(const Ray& sample_ray) const;

private:
    Grid<float> heights_;
    terrain::MinMaxPyramid pyramid_;
    glm::dvec3 scale_{1.0}; // samples of the terrain between two of these
};

/// What view_probes show.
struct ProbedView {
    std::map<std::pair<int, int>, double> tile_pixels; ///< by column and row of the tile
    std::vector<ProbeRay> of_box; ///< the probes through the box around the terrain
};

/// Casts view_probes over a terrain in memory on a plane. With `counted`, which was made of its
/// surface, only every third is cast, and hits are about right. Without, all are cast and exact.
ProbedView probe_view(const DrawList& list, const TerrainDraw& draw, const ProbedSurface* counted);

} // namespace reljef::view
