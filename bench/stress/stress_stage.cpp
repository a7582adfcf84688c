#include "bench/stress/stress_stage.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/truth/draw.h"

namespace reljef::bench {

Result<StressStage> StressStage::create(terrain::Terrain terrain, double exaggeration) {
    if (terrain.color.empty()) {
        const auto& heights = terrain.heightfield.heights;
        terrain.color = Image(heights.cols(), heights.rows(), Rgba8{255, 255, 255, 255});
    }
    StressStage stage;
    const auto node =
        stage.scene_.add_terrain(std::move(terrain), {.placement = terrain::PlacementKind::plane,
                                                      .exaggeration = exaggeration});
    if (!node) {
        return node.error();
    }
    stage.terrain_ = *node;
    stage.camera_ = &stage.scene_.add_camera({});
    // Without light from the sky, whose zenith is the scene's z wherever the terrain is placed.
    stage.light_ = &stage.scene_.add_light({.ambient = glm::vec3(0.0F)});
    return stage;
}

void StressStage::place(const glm::dmat4& world_from_local) {
    for (scene::Node* const node : {terrain_, camera_, light_}) {
        node->set_parent_from_local(world_from_local);
    }
    caster_.reset();
}

void StressStage::look(const scene::Camera& local) {
    *camera_->get<scene::Camera>() = local;
}

bool StressStage::set_technique(const scene::Technique& technique) {
    if (!scene::check_technique(technique, surface())) {
        return false;
    }
    terrain_->get<scene::TerrainNode>()->material.technique = technique;
    return true;
}

const scene::TerrainSurface& StressStage::surface() const {
    return *terrain_->get<scene::TerrainNode>()->surface;
}

Result<HitBuffer> StressStage::hits(session::SceneRenderer& renderer) const {
    return renderer.draw_hits(scene_);
}

Result<Image> StressStage::picture(session::SceneRenderer& renderer) const {
    if (const auto drawn = renderer.draw(scene_); !drawn) {
        return drawn.error();
    }
    return renderer.read_color();
}

Result<HitBuffer> StressStage::true_hits(glm::ivec2 size, const ParallelOptions& parallel) {
    if (!caster_) {
        auto caster = truth::SceneCaster::create(scene_);
        if (!caster) {
            return caster.error();
        }
        caster_ = std::move(*caster);
    }
    return truth::draw_hits(*caster_, scene_.camera(), size, parallel);
}

truth::SurfaceView StressStage::surface_view() const {
    return {surface().heightfield().heights.view(), surface().placement(),
            terrain_->world_from_local(), scene_.camera()};
}

std::size_t count_not_finite(const HitBuffer& hits) {
    const auto pixels = hits.samples();
    return static_cast<std::size_t>(std::count_if(pixels.begin(), pixels.end(), [](const Hit& hit) {
        return !hit.is_sky() && !std::isfinite(hit.col + hit.row + hit.height + hit.depth);
    }));
}

std::size_t count_sky_over_ground(const StressStage& stage, const HitBuffer& shown,
                                  const HitBuffer& truth, double reach) {
    const truth::SurfaceView view = stage.surface_view();
    const glm::dmat4 local_from_world = glm::inverse(view.world_from_local);
    const glm::ivec2 size(shown.cols(), shown.rows());
    const auto shows_ground = [&](glm::dvec2 place) {
        const Ray ray = scene::view_ray(view.camera, size, place);
        return stage.surface()
            .pick({glm::dvec3(local_from_world * glm::dvec4(ray.origin, 1.0)),
                   glm::dvec3(local_from_world * glm::dvec4(ray.direction, 0.0))})
            .has_value();
    };
    std::size_t count = 0;
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            if (truth::shows_terrain(shown(x, y)) || !truth::shows_terrain(truth(x, y))) {
                continue;
            }
            bool is_surrounded = true;
            for (int i = 0; i < 9 && is_surrounded; ++i) {
                const glm::ivec2 step(i % 3 - 1, i / 3 - 1);
                const glm::ivec2 next = glm::ivec2(x, y) + step;
                const bool is_known = reach == 1.0 && next == glm::clamp(next, {}, size - 1);
                is_surrounded =
                    is_known ? truth::shows_terrain(truth(next.x, next.y))
                             : shows_ground(glm::dvec2(x, y) + 0.5 + reach * glm::dvec2(step));
            }
            count += is_surrounded ? 1 : 0;
        }
    }
    return count;
}

bool covers_ground(scene::TechniqueId id) {
    using scene::TechniqueId;
    return id == TechniqueId::polygons || id == TechniqueId::displacement ||
           id == TechniqueId::cone || id == TechniqueId::exact;
}

double silhouette_reach(const scene::Technique& technique) {
    return 1.0 + scene::error_bound(technique);
}

} // namespace reljef::bench
