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
#include "engine/truth/mesh_caster.h"

namespace reljef::truth {

/// A visible terrain node of a scene; owns a reference to its surface.
struct PlacedTerrain {
    std::shared_ptr<const scene::TerrainSurface> surface;
    glm::dmat4 world_from_local;
    glm::dmat4 local_from_world;
    terrain::SurfaceCaster caster;
};

struct SceneHit {
    std::size_t terrain = 0;     ///< index into SceneCaster::terrains()
    terrain::SurfaceHit surface; ///< t along the world ray; place in the terrain's samples
};

/// Intersects rays with the bilinear surfaces of a scene's terrains, and with its meshes, in double
/// precision. Ignores technique, wireframe and later changes of the scene. Thread-safe.
class SceneCaster {
public:
    /// Fails as MeshCaster::create().
    static Result<SceneCaster> create(const scene::Scene& scene);

    [[nodiscard]] const std::vector<PlacedTerrain>& terrains() const { return terrains_; }
    [[nodiscard]] const MeshCaster& meshes() const { return meshes_; }
    /// Of terrains and meshes, world metres.
    [[nodiscard]] const Box& bounds() const { return bounds_; }

    /// The nearest crossing from above to below a terrain, t in `range`. Of equal crossings the
    /// first node's in the tree wins.
    [[nodiscard]] std::optional<SceneHit> first_hit(const Ray& world_ray, Interval range) const;

private:
    SceneCaster() = default;

    std::vector<PlacedTerrain> terrains_;
    MeshCaster meshes_;
    Box bounds_;
};

} // namespace reljef::truth
