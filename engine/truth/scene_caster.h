#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include <glm/mat4x4.hpp>

#include "engine/core/geometry.h"
#include "engine/core/result.h"
#include "engine/scene/graph/scene.h"
#include "engine/terrain/field/surface_caster.h"

namespace reljef::truth {

/// A visible terrain node of a scene, kept alive.
struct PlacedTerrain {
    std::shared_ptr<const scene::TerrainSurface> surface;
    glm::dmat4 world_from_local;
    glm::dmat4 local_from_world;
    terrain::SurfaceCaster caster;
};

/// Where a world ray meets a scene.
struct SceneHit {
    std::size_t terrain = 0;     ///< index into SceneCaster::terrains()
    terrain::SurfaceHit surface; ///< t along the world ray; the place on the terrain's own samples
};

/// Meets the bilinear surfaces of a scene's terrains with rays, in double precision: what a
/// technique should show, so technique and wireframe count for nothing. Safe to ask from several
/// threads; later changes of the scene are not seen.
class SceneCaster {
public:
    /// Fails where a mesh node is visible: its hit is no place on a heightfield.
    static Result<SceneCaster> create(const scene::Scene& scene);

    [[nodiscard]] const std::vector<PlacedTerrain>& terrains() const { return terrains_; }
    /// Of all terrains, world metres.
    [[nodiscard]] const Box& bounds() const { return bounds_; }

    /// The nearest crossing from above to below any of the terrains, t in `range`; of two at one
    /// place that of the node first in the tree.
    [[nodiscard]] std::optional<SceneHit> first_hit(const Ray& world_ray, Interval range) const;

private:
    SceneCaster() = default;

    std::vector<PlacedTerrain> terrains_;
    Box bounds_;
};

} // namespace reljef::truth
