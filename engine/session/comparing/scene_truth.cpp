#include "engine/session/comparing/scene_truth.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "engine/scene/graph/picture_detail.h"

namespace reljef::session {
namespace {

struct PlacedNode {
    scene::TerrainNode node;
    glm::dmat4 world_from_local{1.0};

    friend bool operator==(const PlacedNode&, const PlacedNode&) = default;
};

// Of the terrains, what the truth depends on.
std::vector<PlacedNode> terrains_of(const scene::Scene& scene) {
    std::vector<PlacedNode> terrains;
    scene::visit_visible(scene.root(), [&](const scene::Node& node, const glm::dmat4& to_world) {
        if (const auto* terrain = node.get<scene::TerrainNode>()) {
            scene::TerrainNode bare;
            bare.surface = terrain->surface;
            bare.stream = terrain->stream;
            terrains.push_back({std::move(bare), to_world});
        }
    });
    return terrains;
}

struct PlacedMesh {
    scene::MeshNode node;
    glm::dmat4 world_from_local{1.0};

    friend bool operator==(const PlacedMesh&, const PlacedMesh&) = default;
};

std::vector<PlacedMesh> meshes_of(const scene::Scene& scene) {
    std::vector<PlacedMesh> meshes;
    scene::visit_visible(scene.root(), [&](const scene::Node& node, const glm::dmat4& to_world) {
        if (const auto* mesh = node.get<scene::MeshNode>()) {
            PlacedMesh placed{*mesh, scene::faced(mesh->facing, to_world, scene.camera())};
            placed.node.facing = scene::Facing::node;
            meshes.push_back(std::move(placed));
        }
    });
    return meshes;
}

bool shows_relief(const PlacedMesh& mesh) {
    const scene::SurfaceDetail& detail = mesh.node.material.detail;
    return detail.set != nullptr && !scene::is_picture(detail);
}

} // namespace

Result<SceneTruth> SceneTruth::create(const scene::Scene& scene) {
    std::vector<PlacedMesh> meshes = meshes_of(scene);
    if (std::any_of(meshes.begin(), meshes.end(), shows_relief)) {
        return Error{"the exact picture: models found, a terrain was expected"};
    }
    SceneTruth truth;
    for (PlacedNode& terrain : terrains_of(scene)) {
        truth.is_streamed_ = truth.is_streamed_ || terrain.node.stream != nullptr;
        truth.scene_.root()
            .add("terrain", std::move(terrain.node))
            .set_parent_from_local(terrain.world_from_local);
    }
    for (PlacedMesh& mesh : meshes) {
        truth.scene_.root()
            .add("mesh", std::move(mesh.node))
            .set_parent_from_local(mesh.world_from_local);
    }
    truth.shadow_ = truth::sun_shadow_of(scene);
    truth.sun_ = scene.sun();
    if (truth.sun_) {
        truth.scene_.add_light(*truth.sun_);
    }
    for (const scene::PlacedPointLight& light : scene.point_lights()) {
        truth.scene_.add_point_light(light.light, light.place);
    }
    if (scene.sky()) {
        truth.scene_.set_sky(*scene.sky());
    }
    return truth;
}

bool SceneTruth::is_of(const scene::Scene& scene) const {
    return sun_ == scene.sun() && shadow_ == truth::sun_shadow_of(scene) &&
           scene_.point_lights() == scene.point_lights() && scene_.sky() == scene.sky() &&
           terrains_of(scene_) == terrains_of(scene) && meshes_of(scene_) == meshes_of(scene);
}

Result<void> SceneTruth::prepare() {
    if (is_streamed_ && !streamed_) {
        auto streamed = truth::StreamedTruth::create(scene_);
        if (!streamed) {
            return streamed.error();
        }
        streamed_.emplace(std::move(*streamed));
    }
    if (!is_streamed_ && !shading_) {
        auto caster = truth::SceneCaster::create(scene_);
        if (!caster) {
            return caster.error();
        }
        caster_ = std::make_unique<const truth::SceneCaster>(std::move(*caster));
        shading_.emplace(scene_, *caster_, shadow_);
    }
    return {};
}

Result<truth::Picture> SceneTruth::draw(const scene::Camera& camera, glm::ivec2 size,
                                        truth::DrawOptions options) {
    options.shadow = shadow_;
    if (auto prepared = prepare(); !prepared) {
        return prepared.error();
    }
    return streamed_ ? streamed_->draw(camera, size, options)
                     : truth::draw(*caster_, *shading_, camera, size, options);
}

Result<truth::GeometricErrors> SceneTruth::errors(const scene::Camera& camera,
                                                  const HitBuffer& shown, const HitBuffer& truth,
                                                  const ParallelOptions& parallel) {
    if (streamed_) {
        return streamed_->errors(camera, shown, truth, parallel);
    }
    const auto terrains = terrains_of(scene_);
    if (terrains.size() != 1) {
        return Error{"the errors of a picture: one terrain was expected"};
    }
    const scene::TerrainSurface& surface = *terrains.front().node.surface;
    const truth::SurfaceView view{surface.heightfield().heights.view(), surface.placement(),
                                  terrains.front().world_from_local, camera};
    return truth::geometric_errors(view, shown, truth, parallel.threads);
}

} // namespace reljef::session
