#include "bench/stress/stress_stage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "bench/suites/frame_check.h"
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

namespace {

// Ground around pixels, to the exact rays within a tolerance.
class GroundAround {
public:
    GroundAround(const StressStage& stage, const HitBuffer& truth,
                 const SilhouetteTolerance& tolerance)
        : surface_(stage.surface()), view_(stage.surface_view()), truth_(truth),
          size_(truth.cols(), truth.rows()), tolerance_(tolerance),
          local_from_world_(glm::inverse(view_.world_from_local)) {}

    [[nodiscard]] bool surrounds(glm::ivec2 pixel) const {
        for (int i = 0; i < 9; ++i) {
            if (!is_ground(pixel, {i % 3 - 1, i / 3 - 1})) {
                return false;
            }
        }
        return true;
    }

private:
    [[nodiscard]] bool is_ground(glm::ivec2 pixel, glm::ivec2 step) const {
        const glm::ivec2 next = pixel + step;
        if (tolerance_.pixels == 1.0 && tolerance_.metres == 0.0 &&
            next == glm::clamp(next, {}, size_ - 1)) {
            return truth::shows_terrain(truth_(next.x, next.y));
        }
        const Ray world = scene::view_ray(
            view_.camera, size_, glm::dvec2(pixel) + 0.5 + tolerance_.pixels * glm::dvec2(step));
        const Ray ray{glm::dvec3(local_from_world_ * glm::dvec4(world.origin, 1.0)),
                      glm::dvec3(local_from_world_ * glm::dvec4(world.direction, 0.0))};
        const glm::dvec3 raised(0.0, 0.0, tolerance_.metres); // as if the surface were lower
        return surface_.pick({ray.origin + raised, ray.direction}).has_value() &&
               (tolerance_.metres == 0.0 || enters_above(surface_, ray, tolerance_.metres));
    }

    const scene::TerrainSurface& surface_;
    truth::SurfaceView view_;
    const HitBuffer& truth_;
    glm::ivec2 size_;
    SilhouetteTolerance tolerance_;
    glm::dmat4 local_from_world_;
};

} // namespace

std::size_t count_sky_over_ground(const StressStage& stage, const HitBuffer& shown,
                                  const HitBuffer& truth, const SilhouetteTolerance& tolerance) {
    const GroundAround ground(stage, truth, tolerance);
    std::size_t count = 0;
    for (int y = 0; y < shown.rows(); ++y) {
        for (int x = 0; x < shown.cols(); ++x) {
            const bool is_missed =
                !truth::shows_terrain(shown(x, y)) && truth::shows_terrain(truth(x, y));
            count += is_missed && ground.surrounds({x, y}) ? 1U : 0U;
        }
    }
    return count;
}

bool covers_ground(const scene::Technique& technique) {
    using scene::TechniqueId;
    if (const auto* polygons = std::get_if<scene::Polygons>(&technique.parameters)) {
        return polygons->max_levels == 1 || polygons->error > 0.0;
    }
    const TechniqueId id = technique.id();
    return id == TechniqueId::displacement || id == TechniqueId::cone || id == TechniqueId::exact;
}

SilhouetteTolerance silhouette_tolerance(const StressStage& stage,
                                         const scene::Technique& technique) {
    const double bound = scene::error_bound(technique);
    if (technique.id() != scene::TechniqueId::polygons || bound > 0.0) {
        return {.pixels = 1.0 + bound};
    }
    const Grid<float>& heights = stage.surface().heightfield().heights;
    double twist = 0.0; // of a cell: the bilinear middle and that of a diagonal differ by a quarter
    for (int row = 1; row < heights.rows(); ++row) {
        for (int col = 1; col < heights.cols(); ++col) {
            twist = std::max(twist, std::abs(double{heights(col, row)} - heights(col - 1, row) -
                                             heights(col, row - 1) + heights(col - 1, row - 1)));
        }
    }
    return {.metres = 0.25 * twist * stage.surface().placement().exaggeration()};
}

} // namespace reljef::bench
