// Every technique from views that break searches and meshes, compared with the exact hits.
#include <array>
#include <cmath>
#include <random>

#include <fmt/format.h>
#include <glm/trigonometric.hpp>

#include "bench/stress/made_surfaces.h"
#include "bench/stress/stress_stage.h"
#include "bench/stress/view_check.h"
#include "bench/suites/random_views.h"
#include "engine/scene/motion/poses.h"

namespace reljef::bench {
namespace {

constexpr double grazing_distance = 0.8; // eye to target, terrain widths

// Looks at the middle of the highest level, from an elevation above the horizon in degrees.
scene::Camera grazing_camera(const Box& bounds, double elevation) {
    const double angle = glm::radians(elevation);
    const double distance = grazing_distance * bounds.size().x;
    const glm::dvec3 target(0.0, 0.0, bounds.high.z);
    scene::Camera camera;
    camera.target = target;
    camera.eye = target + distance * glm::dvec3(0.0, -std::cos(angle), std::sin(angle));
    return camera;
}

std::vector<StressView> grazing_views(const Box& bounds) {
    std::vector<StressView> views;
    for (const double elevation : {90.0, 45.0, 10.0, 1.0, 0.1, 0.01}) {
        views.push_back({fmt::format("{} degrees", elevation), grazing_camera(bounds, elevation)});
    }
    return views;
}

scene::Camera rolled(scene::Camera camera, double degrees) {
    const scene::ViewAxes axes = scene::view_axes(camera);
    const double turn = glm::radians(degrees);
    camera.up = std::cos(turn) * axes.up + std::sin(turn) * axes.right;
    return camera;
}

std::vector<StressView> hard_views(const StressStage& stage) {
    const Box bounds = stage.surface().bounds();
    const glm::dvec3 size = bounds.size();
    const auto ground = [&](double x, double y) {
        return stage.surface().height_at(x, y).value_or(0.0);
    };
    const glm::dvec2 at(0.02 * size.x, 0.04 * size.y);
    const double z = ground(at.x, at.y);
    const glm::dvec3 inside(at, z - 0.1 * size.z);
    const glm::dvec3 above(at, bounds.high.z + 0.2 * size.x);
    const scene::Camera overview = scene::pose_camera(scene::Pose::overview, bounds, ground);
    std::vector<StressView> views{
        {"inside the ground", scene::camera_from_angles(inside, 30.0, 0.0)},
        {"under all ground", scene::camera_from_angles({at, bounds.low.z - size.x}, 30.0, 60.0)},
        {"on the ground", scene::camera_from_angles({at, z}, 30.0, 0.0)},
        {"on a vertex", scene::camera_from_angles({0.0, 0.0, ground(0.0, 0.0)}, 30.0, -20.0)},
        {"straight up", scene::camera_from_angles(inside, 0.0, 90.0)},
        {"straight down", scene::camera_from_angles(above, 0.0, -90.0)},
        {"level", scene::camera_from_angles({at, bounds.high.z}, 30.0, 0.0)}};
    for (const double roll : {37.0, 90.0, 180.0}) {
        views.push_back({fmt::format("roll {} degrees", roll), rolled(overview, roll)});
    }
    for (const double fov : {1e-3, 179.0}) {
        scene::Camera camera = overview;
        camera.vertical_fov = fov;
        views.push_back({fmt::format("field of view {} degrees", fov), camera});
    }
    return views;
}

std::vector<StressView> standard_views(const StressStage& stage) {
    const Box bounds = stage.surface().bounds();
    std::vector<StressView> views;
    for (const scene::Pose pose : {scene::Pose::overview, scene::Pose::oblique, scene::Pose::low,
                                   scene::Pose::grazing, scene::Pose::map}) {
        views.push_back({std::string(to_string(pose)),
                         scene::pose_camera(pose, bounds, [&](double x, double y) {
                             return stage.surface().height_at(x, y).value_or(bounds.low.z);
                         })});
    }
    return views;
}

std::vector<StressView> views_near_the_ground(const StressStage& stage, int count,
                                              std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<StressView> views;
    for (int i = 0; i < count; ++i) {
        const scene::Camera camera = view_near_the_ground(random, stage.surface());
        const glm::dvec3 to = camera.target - camera.eye;
        views.push_back({fmt::format("eye {:.3f},{:.3f},{:.3f} towards {:.3f},{:.3f},{:.3f}",
                                     camera.eye.x, camera.eye.y, camera.eye.z, to.x, to.y, to.z),
                         camera});
    }
    return views;
}

// Calls `views_of` for each terrain of the run and checks all techniques.
template <class ViewsOf>
Result<void> check_terrains(StressRun& run, const ViewCheck& check, const ViewsOf& views_of) {
    for (const terrain::Terrain& terrain : run.terrains()) {
        auto stage = StressStage::create(terrain);
        if (!stage) {
            return stage.error();
        }
        if (auto done = check_views(run, check, terrain.name, *stage, views_of(*stage)); !done) {
            return done;
        }
    }
    return {};
}

} // namespace

Result<void> stress_grazing_views(StressRun& run) {
    return check_terrains(
        run, {.stress = "grazing view", .has_row_per_view = true},
        [](const StressStage& stage) { return grazing_views(stage.surface().bounds()); });
}

Result<void> stress_standard_poses(StressRun& run) {
    return check_terrains(run, {.stress = "standard pose"}, standard_views);
}

Result<void> stress_hard_cameras(StressRun& run) {
    auto stage = StressStage::create(made_hills(glm::ivec2(65), 2.0, 12.0));
    if (!stage) {
        return stage.error();
    }
    return check_views(run, {.stress = "hard camera"}, "hills", *stage, hard_views(*stage));
}

Result<void> stress_views_near_the_ground(StressRun& run) {
    return check_terrains(run, {.stress = "eye near the ground"}, [&](const StressStage& stage) {
        return views_near_the_ground(stage, run.cases(2, 40), run.options().seed);
    });
}

} // namespace reljef::bench
