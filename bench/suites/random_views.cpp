#include "bench/suites/random_views.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace reljef::bench {
namespace {

constexpr double lowest = 1e-5; // of the terrain's width, above the ground
constexpr double highest = 0.4;
constexpr double beyond = 0.2; // of the width, outside the terrain
// Near distance, of the height above the ground: cuts no ground away, unless it rises by 700 m per
// metre.
constexpr double near_part = 1e-3;

glm::dvec2 random_place(std::mt19937& random, const scene::TerrainSurface& surface,
                        double outside) {
    const auto& heights = surface.heightfield().heights;
    const double col = between(random, -outside, 1.0 + outside) * (heights.cols() - 1);
    const double row = between(random, -outside, 1.0 + outside) * (heights.rows() - 1);
    return {col, row};
}

// Above the ground, or above the border next to the place, metres of the scene.
glm::dvec3 point_above(const scene::TerrainSurface& surface, glm::dvec2 place, double above) {
    const auto& heights = surface.heightfield().heights;
    const glm::dvec2 last(heights.cols() - 1, heights.rows() - 1);
    const double ground =
        terrain::bilinear_height(heights.view(), glm::clamp(place, glm::dvec2(0.0), last));
    const double height = ground + above / surface.placement().exaggeration();
    return surface.placement().world_from_sample({place, height});
}

scene::Camera camera_towards(std::mt19937& random, const scene::TerrainSurface& surface,
                             glm::dvec3 eye, double lowest_pitch) {
    const terrain::Placement& placement = surface.placement();
    const double heading = between(random, 0.0, 360.0);
    const double pitch = between(random, lowest_pitch, 5.0);
    return scene::camera_from_angles(eye, heading, pitch,
                                     {placement.up(eye), placement.north(eye)});
}

} // namespace

double between(std::mt19937& random, double low, double high) {
    return low +
           (high - low) * static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
}

std::optional<std::mt19937> ViewGenerators::next() {
    const std::int64_t number = count_++;
    if (number < skip_) {
        return std::nullopt;
    }
    std::seed_seq seed{seed_, static_cast<std::uint32_t>(number)}; // the same on every machine
    return std::mt19937(seed);
}

scene::Camera random_view(std::mt19937& random, const scene::TerrainSurface& surface) {
    const bool is_plane = surface.placement().kind() == terrain::PlacementKind::plane;
    const glm::dvec3 size = surface.bounds().size();
    const double above =
        std::max(size.x, size.y) * lowest * std::pow(highest / lowest, between(random, 0.0, 1.0));
    const glm::dvec2 place = random_place(random, surface, is_plane ? beyond : 0.0);
    const glm::dvec3 eye = point_above(surface, place, above);
    scene::Camera camera = camera_towards(random, surface, eye, -90.0);
    if (between(random, 0.0, 2.0) < 1.0) {
        camera.target = point_above(surface, random_place(random, surface, 0.0), 0.0);
        camera.up = surface.placement().up(eye);
    }
    const double fov = between(random, 10.0, 120.0);
    camera.vertical_fov = between(random, 0.0, 3.0) < 1.0 ? fov : camera.vertical_fov;
    camera.near = near_part * above;
    return camera;
}

scene::Camera view_near_the_ground(std::mt19937& random, const scene::TerrainSurface& surface) {
    const double above = 0.3 * std::pow(10.0, between(random, 0.0, 1.0));
    const glm::dvec2 place = random_place(random, surface, -0.05);
    scene::Camera camera =
        camera_towards(random, surface, point_above(surface, place, above), -30.0);
    camera.near = near_part * above;
    return camera;
}

} // namespace reljef::bench
