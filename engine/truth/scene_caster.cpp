#include "engine/truth/scene_caster.h"

#include <utility>

#include <glm/matrix.hpp>

#include "engine/truth/eye.h"

namespace reljef::truth {
namespace {

PlacedTerrain placed(const scene::TerrainNode& node, const glm::dmat4& world_from_local) {
    const scene::TerrainSurface& surface = *node.surface;
    return {node.surface, world_from_local, glm::inverse(world_from_local),
            terrain::SurfaceCaster(surface.heightfield().heights.view(), surface.pyramid(),
                                   surface.placement())};
}

} // namespace

Result<SceneCaster> SceneCaster::create(const scene::Scene& scene) {
    auto meshes = MeshCaster::create(scene);
    if (!meshes) {
        return meshes.error();
    }
    SceneCaster caster;
    caster.meshes_ = std::move(*meshes);
    caster.bounds_.add(caster.meshes_.bounds());
    scene::visit_visible(
        scene.root(), [&](const scene::Node& node, const glm::dmat4& world_from_local) {
            if (const auto* terrain = node.get<scene::TerrainNode>()) {
                caster.terrains_.push_back(placed(*terrain, world_from_local));
                caster.bounds_.add(transformed(world_from_local, terrain->surface->bounds()));
            }
        });
    return caster;
}

std::optional<SceneHit> SceneCaster::first_hit(const Ray& world_ray, Interval range) const {
    std::optional<SceneHit> nearest;
    for (std::size_t i = 0; i < terrains_.size(); ++i) {
        const PlacedTerrain& terrain = terrains_[i];
        const auto hit =
            terrain.caster.first_hit(transformed(terrain.local_from_world, world_ray), range);
        if (hit && (!nearest || hit->t < nearest->surface.t)) {
            nearest = SceneHit{i, *hit};
        }
    }
    return nearest;
}

} // namespace reljef::truth
